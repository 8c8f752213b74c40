// The kernels that turn lights and depth bounds into a grid, in two shapes with the same contract.
#pragma once

#include <memory>
#include <string>

#include "cl/buffers.h"
#include "cl/device.h"
#include "cl/program_cache.h"
#include "shared/cull_params.h"
#include "shared/cull_settings.h"

namespace lightgrid {

struct CullJob {
  const CullParams& params;
  cl::Buffer params_buffer, lights, light_masks, bounds, tile_masks, slices, counters, cells, indices;
};

struct PipelineOptions {
  // Each kernel gets only the defines that it reads, so that none is compiled twice to the same code.
  std::string light_defines;  // cull test, cones
  std::string cell_defines;   // these, the depth-bounds mode, slices
  bool portable = false;      // as in CullerOptions
  bool slices = false;        // cells a tile: more than one
  bool cones = false;         // at least one light is a spot
  bool masks = false;         // tiles have the masks of their surfaces
  int index_bytes = 2;
  int group_size = 0;  // as in CullerOptions
  bool operator==(const PipelineOptions&) const = default;
};

inline std::string index_define(const PipelineOptions& options) {
  return options.index_bytes == 4 ? " -DINDEX_32" : "";
}

class CullPipeline {
 public:
  explicit CullPipeline(const PipelineOptions& options) : options(options) {}
  const PipelineOptions options;
  virtual ~CullPipeline() = default;
  // Creates or enlarges its buffers for the job. params gives the capacity for candidates and staged lists
  // (or marks).
  virtual void prepare(const CullParams& params) = 0;
  // Enqueues all kernels without waiting. Afterwards counters hold: [0] batches of 16 candidates and [1]
  // units of 16 staged words needed, [3] whether a bin overflowed, [4] and [5] low and high word of the
  // number of indices.
  virtual void enqueue(const CullJob& job) = 0;
  virtual size_t candidate_bytes() const = 0;  // bytes per candidate
  virtual size_t memory_bytes() const = 0;
};

std::unique_ptr<CullPipeline> make_cull_cpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                     const PipelineOptions& options);
std::unique_ptr<CullPipeline> make_cull_gpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                     const PipelineOptions& options);

}  // namespace lightgrid
