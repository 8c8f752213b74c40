// Which lights a pixel reads: a light loop's text and input, in GLSL and in OpenCL C, and the same lists for
// the host. Every builder of lists makes one.
#pragma once

#include <memory>

#include "cl/launch.h"
#include "passes/common/frame.h"

namespace lightgrid {

// Lights that one plain loop may visit. llvmpipe ends a shader's loops after 65,535 iterations together
// (shaders/lights/blocks.glsl). The loops over masks and z-bins take two per light and one per word, those of
// voxel-lights-exact two per light.
inline constexpr size_t longest_plain_loop = 16384;

// The loop of shaders/forward.frag.
struct GlLightLoop {
  std::vector<std::string> defines;  // which loop, and its input
  struct Binding {
    Sampler sampler;
    GLuint texture;
    size_t element = 0;  // index in an array of samplers
  };
  std::vector<Binding> textures;
  struct Block {
    UniformBlock block;
    GLuint buffer;
  };
  std::vector<Block> blocks;  // uniform blocks besides the view's

  void bind(PassContext& work) const;  // binds these textures, the lights and the view
};

// The loop of kernels/resolve/resolve_light.h.
struct ClLightLoop {
  std::string defines;                // -D options; none: lists of cells, or every light
  cl::Buffer cells, indices, z_bins;  // null: every light
  ClArguments more;                   // arguments that the defines add, in their order
};

class LightSource {
 public:
  // in_gl: hands the lists to OpenGL, in passes of its own. Without in_cl no kernel reads these lists. bytes:
  // of the lists, for passes that count bytes read.
  explicit LightSource(std::function<GlLightLoop()> in_gl, std::optional<ClLightLoop> in_cl = {},
                       size_t bytes = 0, HostLists listed = {})
      : in_cl(std::move(in_cl)), bytes(bytes), listed(std::move(listed)), make_gl_(std::move(in_gl)) {}

  // Made by the first pass that reads it, for all copies of this source.
  const GlLightLoop& in_gl() const {
    if (!*gl_) *gl_ = make_gl_();
    return **gl_;
  }

  std::optional<ClLightLoop> in_cl;
  size_t bytes;
  HostLists listed;

 private:
  std::function<GlLightLoop()> make_gl_;
  std::shared_ptr<std::optional<GlLightLoop>> gl_ = std::make_shared<std::optional<GlLightLoop>>();
};

// Every light of the scene at every pixel.
LightSource every_light(const ViewState& seen);

// The beginning of every loop over point and spot lights; a source adds its own loop and input.
GlLightLoop light_loop(const ViewState& seen);
// A loop without point and spot lights: ambient, emissive and directional light alone.
GlLightLoop base_lighting(const ViewState& seen);

}  // namespace lightgrid
