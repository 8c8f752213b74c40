// Uniform blocks of a view and its lights in view space, as OpenGL's shaders read them.
#pragma once

#include "gl/objects.h"
#include "renderer/light_table.h"
#include "shared/view_params.h"

namespace lightgrid {

class ViewLightBuffers {
 public:
  // Uploads the view and the plan's lights. Buffers are kept unless their sizes change.
  void update(const Scene& scene, const View& view, const FramePlan& plan, const ViewParams& params);
  void bind() const;
  size_t light_bytes() const { return light_bytes_; }

 private:
  struct Sized {
    GlBuffer buffer;
    size_t bytes = 0;
    bool put(size_t size, const void* data);  // true: a new buffer was created
  };
  Sized view_block_, slice_block_, z_bin_block_;
  struct Lights {
    Sampler sampler{};
    Sized buffer;
    GlTexture texture;
  };
  Lights lights_[light_column_count + 1];  // the light table's columns, and directional lights
  size_t light_bytes_ = 0;
};

}  // namespace lightgrid
