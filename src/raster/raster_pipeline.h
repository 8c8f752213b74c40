// The kernels that draw a frame, in one of two shapes with one contract.
#pragma once

#include <memory>

#include "cl/buffers.h"
#include "cl/program_cache.h"
#include "raster/raster_view.h"
#include "shared/raster_params.h"

namespace lightgrid {

struct RasterJob {
  const RasterParams& params;
  cl::Buffer params_buffer;
  // The scene, as raster_arrays.h has it.
  cl::Buffer positions, indices, cluster_indices, cluster_triangles, clusters, instances, vertex_runs, pairs;
  cl::Buffer frame;                              // RasterFrameInstance an instance
  cl::Buffer clip, triangles, depths, counters;  // triangles and depths null: no image is drawn
  const RasterMasks& masks;
};

class RasterPipeline {
 public:
  virtual ~RasterPipeline() = default;
  // How many parts the clusters in view are taken in.
  virtual uint32_t chunks(const RasterParams& params) const = 0;
  // Makes or grows its buffers for the numbers and the room of the params.
  virtual void prepare(const RasterParams& params) = 0;
  // Enqueues all, waits for nothing. Counters (raster_params.h) are cleared first. Where they show that room
  // was short, the image was not written.
  virtual void enqueue(const RasterJob& job) = 0;
  // What enqueue listed.
  virtual RasterLists lists(const RasterParams& params) const = 0;
  virtual size_t memory_bytes() const = 0;
};

std::unique_ptr<RasterPipeline> make_raster_cpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool portable);
// Without `wide_atomics`, or where the device has none of 64 bits, in two passes.
std::unique_ptr<RasterPipeline> make_raster_gpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool wide_atomics);

}  // namespace lightgrid
