// project_lights -> list_candidates -> mark_cells -> fill_lists: for GPUs.
#include <fmt/format.h>

#include <algorithm>

#include "cl/launch.h"
#include "culling/cull_pipeline.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr size_t fill_items = 256, most_word_groups = 32;
constexpr size_t most_list_items = 1024;  // the more wait for memory at once, the better

size_t rounded_up(size_t n, size_t step) { return (n + step - 1) / step * step; }

class GroupPipeline : public CullPipeline {
 public:
  GroupPipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options)
      : CullPipeline(options), device_(device) {
    project_ = programs.kernel("project_lights_group", options.light_defines);
    const size_t allowed = device.device().getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    if (options.group_size > 0) list_items_ = size_t(options.group_size);
    while (list_items_ > allowed) list_items_ /= 2;
    list_ = programs.kernel("list_candidates_group", fmt::format("{} -DGROUP={}", options.defines, list_items_));
    mark_cells_ = programs.kernel("mark_cells_group", options.defines);
    fill_ = programs.kernel("fill_lists_group", options.defines);
  }

  void prepare(const CullParams& p) override {
    const size_t bins = size_t(p.bins_x) * p.bins_y;
    views_.at_least(device_, size_t(p.light_stride) * options.view_arrays * sizeof(float));
    pool_.at_least(device_, size_t(p.pool_blocks) * 16 * options.view_arrays * sizeof(float));
    cell_marks_.at_least(device_, size_t(p.staging_units) * 16 * sizeof(cl_uint));
    bins_.at_least(device_, bins * sizeof(cl_uint4));
  }

  void enqueue(const CullJob& job) override {
    const size_t bins = size_t(job.params.bins_x) * job.params.bins_y, words = (size_t(job.params.light_count) + 31) / 32;
    launch(device_, "project_lights", project_, cl::NDRange(rounded_up(std::max(job.params.light_stride, 8u), 64)),
           cl::NDRange(64), job.lights, views_.get(), job.counters, job.params_buffer);
    launch(device_, "list_candidates", list_, cl::NDRange(bins * list_items_), cl::NDRange(list_items_), views_.get(),
           job.bounds, pool_.get(), bins_.get(), job.counters, job.params_buffer);
    launch(device_, "mark_cells", mark_cells_, cl::NDRange(bins * BIN_SIZE, std::min(words, most_word_groups)),
           cl::NDRange(BIN_SIZE, 1), pool_.get(), bins_.get(), job.bounds, job.slices, cell_marks_.get(), job.params_buffer);
    launch(device_, "fill_lists", fill_, cl::NDRange(bins * fill_items), cl::NDRange(fill_items), pool_.get(), bins_.get(),
           cell_marks_.get(), job.cells, job.indices, job.counters, job.params_buffer);
  }

  size_t memory_bytes() const override {
    return views_.bytes() + pool_.bytes() + cell_marks_.bytes() + bins_.bytes();
  }

 private:
  ClDevice& device_;
  size_t list_items_ = most_list_items;
  cl::Kernel project_, list_, mark_cells_, fill_;
  GrowingBuffer views_, pool_, cell_marks_, bins_;
};

}  // namespace

std::unique_ptr<CullPipeline> make_group_pipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options) {
  return std::make_unique<GroupPipeline>(device, programs, options);
}

}  // namespace lightgrid
