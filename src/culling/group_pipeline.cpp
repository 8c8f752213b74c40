// project_lights -> cull_lights -> write_lists, for GPUs.
#include <fmt/format.h>

#include "cl/launch.h"
#include "culling/cull_pipeline.h"
#include "shared/cull_constants.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr size_t project_items = PROJECT_GROUP, block_tiles = BLOCK_TILES;
constexpr size_t bin_blocks = BIN_TILES / block_tiles * (BIN_TILES / block_tiles);
constexpr size_t usual_items = 256;  // of kernels whose work-groups may have any size

// Empty if `items` is the kernel's own default.
std::string group_define(size_t items) {
  return items == usual_items ? "" : fmt::format(" -DGROUP={}", items);
}

class GroupPipeline : public CullPipeline {
 public:
  GroupPipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options)
      : CullPipeline(options), device_(device) {
    const size_t allowed = device.info().max_group_items;
    if (allowed < project_items) {
      throw machine_error(
          "light culling: kernel shape group needs work-groups of {} items, and {} allows {}; use shape "
          "lanes",
          project_items, device.info().name, allowed);
    }
    project_ = programs.kernel("culling/gpu/project_lights", options.light_defines);
    while (write_items_ > allowed) write_items_ /= 2;
    if (options.group_size > 0) cull_items_ = size_t(options.group_size);
    while (cull_items_ > allowed) cull_items_ /= 2;
    cull_ = programs.kernel("culling/gpu/cull_lights",
                            fmt::format("{} -DGROUP={}", options.cell_defines, cull_items_));
    write_ = programs.kernel("culling/gpu/write_lists", index_define(options) + group_define(write_items_));
  }

  void prepare(const CullParams& p) override {
    const size_t record = options.cones ? 12 : 8;  // floats
    const size_t lines = (p.bins_x + p.bins_y) * (BIN_TILES / block_tiles);
    views_.at_least(device_, p.light_stride * record * sizeof(float));
    light_marks_.at_least(device_, lines * project_groups(p) * (project_items / 32) * sizeof(cl_uint));
    ids_.at_least(device_, size_t(p.pool_batches) * 16 * candidate_bytes());
    cell_marks_.at_least(device_, size_t(p.staging_units) * 16 * sizeof(cl_uint));
    places_.at_least(device_, blocks(p) * sizeof(cl_uint4));
    totals_.at_least(device_, blocks(p) * sizeof(cl_ulong));
  }

  void enqueue(const CullJob& job) override {
    const CullParams& p = job.params;
    launch(device_, "project_lights", project_, cl::NDRange(project_groups(p) * project_items),
           cl::NDRange(project_items), job.lights, views_.get(), light_marks_.get(), job.counters,
           job.params_buffer);
    launch(device_, "cull_lights", cull_, cl::NDRange(blocks(p) * cull_items_), cl::NDRange(cull_items_),
           views_.get(), light_marks_.get(), job.bounds, job.slices, ids_.get(), places_.get(), totals_.get(),
           cell_marks_.get(), job.cells, job.counters, job.params_buffer);
    launch(device_, "write_lists", write_, cl::NDRange(blocks(p) * write_items_), cl::NDRange(write_items_),
           ids_.get(), places_.get(), totals_.get(), cell_marks_.get(), job.cells, job.indices, job.counters,
           job.params_buffer);
  }

  size_t candidate_bytes() const override { return sizeof(cl_uint); }

  size_t memory_bytes() const override {
    return views_.bytes() + light_marks_.bytes() + ids_.bytes() + cell_marks_.bytes() + places_.bytes() +
           totals_.bytes();
  }

 private:
  static size_t project_groups(const CullParams& p) {
    return (p.light_count + project_items - 1) / project_items;
  }
  static size_t blocks(const CullParams& p) { return size_t(p.bins_x) * p.bins_y * bin_blocks; }

  ClDevice& device_;
  size_t cull_items_ = usual_items, write_items_ = usual_items;
  cl::Kernel project_, cull_, write_;
  GrowingBuffer views_, light_marks_, ids_, cell_marks_, places_, totals_;
};

}  // namespace

std::unique_ptr<CullPipeline> make_group_pipeline(ClDevice& device, ProgramCache& programs,
                                                  const PipelineOptions& options) {
  return std::make_unique<GroupPipeline>(device, programs, options);
}

}  // namespace lightgrid
