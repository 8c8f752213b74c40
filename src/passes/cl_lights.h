// What light loops in OpenCL read of a view besides its grid: lights in view space, the view, z-bin edges.
#pragma once

#include "renderer/render_view.h"

namespace lightgrid {

// A read-only buffer that is written again in place while its size stays.
class UploadedBuffer {
 public:
  template <typename T>
  void put(ClDevice& device, const char* what, const std::vector<T>& values) {
    put(device, what, values.data(), values.size() * sizeof(T));
  }
  const cl::Buffer& buffer() const { return buffer_; }
  size_t bytes() const { return bytes_; }

 private:
  void put(ClDevice& device, const char* what, const void* data, size_t bytes);

  cl::Buffer buffer_;
  size_t bytes_ = 0;
};

class ClLights {
 public:
  void upload(RenderView& v);
  size_t memory_bytes() const;

  UploadedBuffer positions, colors, cones, directional, view,
      bin_edges;  // shared/punctual_light.h, shared/slices.h
};

// The -D names that light loops in OpenCL take of a view and its plan (kernels/common/shade_pixels.h).
// `lanes`: those of kernels that take a tile.
std::string light_defines(const RenderView& v, bool lanes);

// Whether kernels that shade pixels take the shape for CPUs.
bool shades_in_lanes(const RenderView& v);

}  // namespace lightgrid
