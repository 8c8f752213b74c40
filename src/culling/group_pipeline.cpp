// project_lights -> mark_cells -> fill_lists: for GPUs.
#include <fmt/format.h>

#include "cl/launch.h"
#include "culling/cull_pipeline.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr size_t project_items = 128, bin_blocks = 4, block_tiles = 4;  // kernels/common/group_grid.h
constexpr size_t usual_items = 256;  // of kernels whose work-groups may have any size

// Empty if `items` is the kernel's own default.
std::string group_define(size_t items) { return items == usual_items ? "" : fmt::format(" -DGROUP={}", items); }

class GroupPipeline : public CullPipeline {
 public:
  GroupPipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options)
      : CullPipeline(options), device_(device) {
    const size_t allowed = device.info().max_group_items;
    if (allowed < project_items) {
      throw machine_error("light culling: kernel shape group needs work-groups of {} items, and {} allows {}; use shape lanes",
                          project_items, device.info().name, allowed);
    }
    project_ = programs.kernel("project_lights_group", options.light_defines);
    while (fill_items_ > allowed) fill_items_ /= 2;
    if (options.group_size > 0) mark_items_ = size_t(options.group_size);
    while (mark_items_ > allowed) mark_items_ /= 2;
    mark_cells_ = programs.kernel("mark_cells_group", fmt::format("{} -DGROUP={}", options.defines, mark_items_));
    fill_ = programs.kernel("fill_lists_group", options.defines + group_define(fill_items_));
  }

  void prepare(const CullParams& p) override {
    const size_t record = options.cones ? 12 : 8;  // floats
    const size_t lines = (p.bins_x + p.bins_y) * (BIN_TILES / block_tiles);
    views_.at_least(device_, p.light_stride * record * sizeof(float));
    light_marks_.at_least(device_, lines * project_groups(p) * (project_items / 32) * sizeof(cl_uint));
    ids_.at_least(device_, size_t(p.pool_blocks) * 16 * candidate_bytes());
    cell_marks_.at_least(device_, size_t(p.staging_units) * 16 * sizeof(cl_uint));
    places_.at_least(device_, blocks(p) * sizeof(cl_uint4));
    totals_.at_least(device_, blocks(p) * sizeof(cl_ulong));
  }

  void enqueue(const CullJob& job) override {
    const CullParams& p = job.params;
    launch(device_, "project_lights", project_, cl::NDRange(project_groups(p) * project_items), cl::NDRange(project_items),
           job.lights, views_.get(), light_marks_.get(), job.counters, job.params_buffer);
    launch(device_, "mark_cells", mark_cells_, cl::NDRange(blocks(p) * mark_items_), cl::NDRange(mark_items_), views_.get(),
           light_marks_.get(), job.bounds, job.slices, ids_.get(), places_.get(), totals_.get(), cell_marks_.get(), job.cells,
           job.counters, job.params_buffer);
    launch(device_, "fill_lists", fill_, cl::NDRange(blocks(p) * fill_items_), cl::NDRange(fill_items_), ids_.get(),
           places_.get(), totals_.get(), cell_marks_.get(), job.cells, job.indices, job.counters, job.params_buffer);
  }

  size_t candidate_bytes() const override { return sizeof(cl_uint); }

  size_t memory_bytes() const override {
    return views_.bytes() + light_marks_.bytes() + ids_.bytes() + cell_marks_.bytes() + places_.bytes() + totals_.bytes();
  }

 private:
  static size_t project_groups(const CullParams& p) { return (p.light_count + project_items - 1) / project_items; }
  static size_t blocks(const CullParams& p) { return size_t(p.bins_x) * p.bins_y * bin_blocks; }

  ClDevice& device_;
  size_t mark_items_ = usual_items, fill_items_ = usual_items;
  cl::Kernel project_, mark_cells_, fill_;
  GrowingBuffer views_, light_marks_, ids_, cell_marks_, places_, totals_;
};

}  // namespace

std::unique_ptr<CullPipeline> make_group_pipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options) {
  return std::make_unique<GroupPipeline>(device, programs, options);
}

}  // namespace lightgrid
