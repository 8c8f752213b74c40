// What light loops in OpenCL read of a view besides its grid: lights in view space, the view, z-bin edges.
#pragma once

#include "cl/uploaded_buffer.h"
#include "renderer/render_view.h"

namespace lightgrid {

class ClLights {
 public:
  void upload(RenderView& v);
  size_t memory_bytes() const;

  UploadedBuffer positions, colors, cones, directional, view, bin_edges,
      slice_edges;  // shared/punctual_light.h, shared/slices.h
};

// The -D names that light loops in OpenCL take of a view and its plan (kernels/resolve/shade_pixels.h).
// `lanes`: those of kernels that take a tile. brdf: of the kernel, which may serve several of the setting's.
std::string light_defines(const RenderView& v, bool lanes, Brdf brdf);

// Whether kernels that shade pixels take the shape for CPUs.
bool shades_in_lanes(const RenderView& v);

}  // namespace lightgrid
