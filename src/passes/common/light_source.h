// Where an OpenGL light loop finds a pixel's lights: its shader text and the buffers it reads.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

class ObjectLights;
struct VoxelTextures;

struct LightSource {
  std::vector<std::string> defines;  // for shaders/forward.frag: which loop, and its input
  struct Binding {
    Sampler sampler;
    GLuint texture;
    size_t element = 0;  // of an array of samplers
  };
  std::vector<Binding> textures;
  struct Block {
    UniformBlock block;
    GLuint buffer;
  };
  std::vector<Block> blocks;  // uniform blocks besides the view's
  size_t bytes = 0;           // of the lists, for passes that count bytes read

  void bind(const RenderView& v) const;  // binds these textures, the lights and the view
};

// Every light of the scene at every pixel.
LightSource every_light(const RenderView& v);
// The lights of the pixel's cell.
LightSource from_grid(const RenderView& v, const GridTextures& grid);
// The lights in the pixel's light indices.
LightSource from_light_index(const RenderView& v, const LightIndexImages& index);
// The lights of the current object (uniform lights_of_draw).
LightSource from_objects(const RenderView& v, const ObjectLights& objects);
// The light of a voxel light buffer (passes/build_voxels.h), and with voxel-lights-exact of lights of the
// pixel's cell.
LightSource from_voxels(const RenderView& v, const VoxelTextures& voxels, const GridTextures& grid);
// No point or spot light: ambient, emissive and directional light alone.
LightSource base_lighting(const RenderView& v);

}  // namespace lightgrid
