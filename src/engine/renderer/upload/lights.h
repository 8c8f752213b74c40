// The lights of a view and all else that light loops read besides their lists, uploaded for each API that
// reads them: the light table (shared/light_table.h), directional lights, the view, slice and z-bin edges.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cl/buffers.h"
#include "cl/launch.h"
#include "gl/bindings.h"
#include "gl/objects.h"
#include "plan/frame_plan.h"
#include "renderer/shared_grids.h"
#include "scene/view_lights.h"
#include "shared/light_table.h"
#include "shared/view_params.h"

namespace lightgrid {

struct ViewState;

#define LIGHT_COLUMN_COUNT(...) +1
inline constexpr size_t light_column_count = 0 LIGHT_TABLE(LIGHT_COLUMN_COUNT);
#undef LIGHT_COLUMN_COUNT

// The defines with which light loops read the plan's columns and no others, with the window of its ranges
// (shared/punctual_light.h).
std::vector<const char*> light_table_defines(const FramePlan& plan);

// The defines with which light loops read a frame's shadows, and find_shadows writes them
// (shared/shadow_bits.h). None where the plan's `light_reaches` is not set.
std::vector<const char*> shadow_defines(const FramePlan& plan);
// Adds the defines with which light loops call NAME_meets and NAME_reach of effects.
std::vector<std::string> reach_defines(const FramePlan& plan);

// Uniform blocks and buffer textures, as OpenGL's shaders read them.
class GlLights {
 public:
  // Buffers are kept unless their sizes change.
  void upload(const ViewState& seen);
  void bind() const;
  size_t light_bytes() const { return light_bytes_; }

 private:
  struct Sized {
    GlBuffer buffer;
    size_t bytes = 0;
    bool put(size_t size, const void* data);  // true: a new buffer was created
  };
  Sized view_block_, slice_block_, z_bin_block_, lights_block_;
  struct Lights {
    Sampler sampler{};
    Sized buffer;
    GlTexture texture;
  };
  Lights lights_[light_column_count + 1];  // the light table's columns, and directional lights
  size_t light_bytes_ = 0;
};

class ClLightColumns {
 public:
  // lights: of the scene, along any axes; those of plan.lights.local are uploaded.
  void upload(ClDevice& device, const FramePlan& plan, std::span<const ViewLight> lights);
  size_t memory_bytes() const;

  // The light table's part of LIGHT_ARGUMENTS.
  ClArguments columns() const;

 protected:
  UploadedBuffer columns_[light_column_count];
};

class ClLights : public ClLightColumns {
 public:
  void upload(ClDevice& device, const ViewState& seen);
  size_t memory_bytes() const;

  UploadedBuffer directional, view, bin_edges, slice_edges;  // shared/slices.h
};

// A frame's shadows, which passes/find_shadows.h fills. Only where the plan's `light_reaches` is set.
struct ShadowMemory {
  SharedTexture tiles, bits;  // shared/shadow_bits.h
  // For blended surfaces: images of triangles' numbers, and of depths after them, `layer_count` each. In
  // OpenGL numbers are those of rays, and `first_triangles` has that of each instance's first.
  SharedTexture layers;
  uint32_t layer_count = 0;
  std::vector<uint32_t> first_triangles;
  // With several samples a pixel, of kernels that find shadows where they shade
  // (kernels/shadows/traced_shadows.h): TRACED_ARGUMENTS, and the defines that they take. Empty: no light is
  // hidden anywhere.
  ClArguments traced;
  std::string traced_defines;

  void bind() const;
  // SHADOW_ARGUMENTS.
  ClArguments arguments();
  size_t bytes() const { return tiles.bytes() + bits.bytes() + layers.bytes(); }
};

// The -D names that light loops in OpenCL take for a view and its plan (kernels/resolve/shade_pixels.h).
// lanes: the kernel's items take a tile. brdf: the kernel's, which may serve several values of the setting.
std::string light_defines(const ViewState& seen, bool lanes, Brdf brdf);

}  // namespace lightgrid
