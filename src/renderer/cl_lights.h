// What light loops in OpenCL read of a view besides its lists: the light table, the view, slice and z-bin
// edges.
#pragma once

#include "cl/launch.h"
#include "cl/buffers.h"
#include "renderer/light_table.h"
#include "shared/view_params.h"

namespace lightgrid {

struct Seen;
struct Work;

class ClLights {
 public:
  void upload(ClDevice& device, const Scene& scene, const View& view, const FramePlan& plan,
              const ViewParams& params);
  size_t memory_bytes() const;

  // LIGHT_ARGUMENTS (shared/light_table.h).
  ClArguments columns() const;

  UploadedBuffer directional, view, bin_edges, slice_edges;  // shared/slices.h

 private:
  UploadedBuffer columns_[light_column_count];
};

// The -D names that light loops in OpenCL take of a view and its plan (kernels/resolve/shade_pixels.h).
// `lanes`: those of kernels that take a tile. brdf: of the kernel, which may serve several of the setting's.
std::string light_defines(const Seen& seen, bool lanes, Brdf brdf);

// Whether kernels that shade pixels take the shape for CPUs.
bool shades_in_lanes(Work& work, const Seen& seen);

}  // namespace lightgrid
