// project_lights -> cull_lights -> write_lists, for CPUs and for GPUs.
#include "culling/cull_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cl/launch.h"
#include "shared/cull_constants.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

constexpr size_t items_a_unit = 16;      // few enough that their buffers stay in the cache, enough to balance
                                         // load
constexpr size_t max_write_items = 512;  // each adds up the totals of all bins before its own
constexpr size_t spare = 64;             // values that a vector load or store may access past the last

// Near the golden section of n, and coprime to it: steps of this size visit all of n and are spread evenly
// from the start.
size_t spreading_step(size_t n) {
  size_t step = std::max<size_t>(1, size_t(0.382 * double(n)));
  while (std::gcd(step, n) > 1) --step;
  return step;
}

class CullCpuPipeline : public CullPipeline {
 public:
  CullCpuPipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options)
      : CullPipeline(options), device_(device) {
    const std::string form = options.portable ? " -DPORTABLE" : "", index = index_define(options);
    project_ = NamedKernel(programs, "culling/cpu/project_lights", options.light_defines + form);
    cull_ = NamedKernel(programs, "culling/cpu/cull_lights", options.cell_defines + index + form);
    write_ =
        NamedKernel(programs, "culling/cpu/write_lists", index + (options.slices ? " -DSLICES" : "") + form);
  }

  void prepare(const CullParams& p) override {
    const size_t regions = size_t(p.regions_x) * p.regions_y, bins = size_t(p.bins_x) * p.bins_y;
    runs_ = std::clamp<uint>(p.light_stride / 512, 1, std::max(4, 2 * device_.info().compute_units));
    records_.at_least(device_, size_t(p.light_stride) * (options.cones ? 12 : 8) * sizeof(float));
    lists_.at_least(device_, (regions * 3 * (p.light_stride + 16) + spare) * sizeof(cl_uint));
    run_counts_.at_least(device_, regions * runs_ * sizeof(cl_uint));
    pool_.at_least(device_, size_t(p.pool_batches) * 16 * candidate_bytes() + spare * sizeof(float));
    staged_.at_least(device_, (size_t(p.staging_units) * 16 + spare) * options.index_bytes);
    cell_counts_.at_least(device_, bins * BIN_SIZE * p.slices * sizeof(cl_uint));
    bins_.at_least(device_, bins * sizeof(cl_uint2));
  }

  void enqueue(const CullJob& job) override {
    const size_t bins = size_t(job.params.bins_x) * job.params.bins_y;
    project_.launch(device_, "project_lights", cl::NDRange(runs_), cl::NDRange(1),
                    {{"lights", job.lights},
                     {"records", records_.get()},
                     {"lists", lists_.get()},
                     {"counts", run_counts_.get()},
                     {"counters", job.counters},
                     {"p", job.params_buffer}});
    const size_t quads = size_t((job.params.bins_x + 1) / 2) * ((job.params.bins_y + 1) / 2);
    const size_t most = items_a_unit * size_t(device_.info().compute_units),
                 rounds = (quads + most - 1) / most;
    cull_.launch(device_, "cull_lights", cl::NDRange((quads + rounds - 1) / rounds), cl::NDRange(1),
                 {{"records", records_.get()},
                  {"lists", lists_.get()},
                  {"counts", run_counts_.get()},
                  {"runs", runs_},
                  {"spread", cl_uint(spreading_step(quads))},
                  {"light_masks", job.light_masks},
                  {"bounds", job.bounds},
                  {"tile_masks", job.tile_masks},
                  {"slices", job.slices},
                  {"pool", pool_.get()},
                  {"staged", staged_.get()},
                  {"cell_counts", cell_counts_.get()},
                  {"bins", bins_.get()},
                  {"counters", job.counters},
                  {"p", job.params_buffer}});
    const size_t run = (bins + max_write_items - 1) / max_write_items;
    write_.launch(device_, "write_lists", cl::NDRange((bins + run - 1) / run), cl::NDRange(1),
                  {{"bins", bins_.get()},
                   {"run", cl_uint(run)},
                   {"cell_counts", cell_counts_.get()},
                   {"staged", staged_.get()},
                   {"cells", job.cells},
                   {"indices", job.indices},
                   {"counters", job.counters},
                   {"p", job.params_buffer}});
  }

  size_t candidate_bytes() const override {
    return ((options.cones ? 10 : 6) + options.masks) * sizeof(float);
  }

  size_t memory_bytes() const override {
    return records_.bytes() + lists_.bytes() + run_counts_.bytes() + pool_.bytes() + staged_.bytes() +
           cell_counts_.bytes() + bins_.bytes();
  }

 private:
  ClDevice& device_;
  cl_uint runs_ = 1;
  NamedKernel project_, cull_, write_;
  GrowingBuffer records_, lists_, run_counts_, pool_, staged_, cell_counts_, bins_;
};

constexpr size_t project_items = PROJECT_GROUP, block_tiles = BLOCK_TILES;
constexpr size_t bin_blocks = BIN_TILES / block_tiles * (BIN_TILES / block_tiles);
constexpr size_t usual_items = 256;  // for kernels whose work-groups may have any size

// Empty if `items` is the kernel's own default.
std::string group_define(size_t items) {
  return items == usual_items ? "" : fmt::format(" -DGROUP={}", items);
}

class CullGpuPipeline : public CullPipeline {
 public:
  CullGpuPipeline(ClDevice& device, ProgramCache& programs, const PipelineOptions& options)
      : CullPipeline(options), device_(device) {
    const size_t allowed = device.info().max_group_items;
    if (allowed < project_items) {
      throw machine_error(
          "light culling: kernel shape group needs work-groups of {} items, and {} allows {}; use shape "
          "lanes",
          project_items, device.info().name, allowed);
    }
    project_ = NamedKernel(programs, "culling/gpu/project_lights", options.light_defines);
    while (write_items_ > allowed) write_items_ /= 2;
    if (options.group_size > 0) cull_items_ = size_t(options.group_size);
    while (cull_items_ > allowed) cull_items_ /= 2;
    cull_ = NamedKernel(programs, "culling/gpu/cull_lights",
                        fmt::format("{} -DGROUP={}", options.cell_defines, cull_items_));
    write_ =
        NamedKernel(programs, "culling/gpu/write_lists", index_define(options) + group_define(write_items_));
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
    project_.launch(device_, "project_lights", cl::NDRange(project_groups(p) * project_items),
                    cl::NDRange(project_items),
                    {{"lights", job.lights},
                     {"views", views_.get()},
                     {"marks", light_marks_.get()},
                     {"counters", job.counters},
                     {"p", job.params_buffer}});
    cull_.launch(device_, "cull_lights", cl::NDRange(blocks(p) * cull_items_), cl::NDRange(cull_items_),
                 {{"views", views_.get()},
                  {"light_marks", light_marks_.get()},
                  {"light_masks", job.light_masks},
                  {"bounds", job.bounds},
                  {"tile_masks", job.tile_masks},
                  {"slices", job.slices},
                  {"ids", ids_.get()},
                  {"offsets", places_.get()},
                  {"totals", totals_.get()},
                  {"marks", cell_marks_.get()},
                  {"cells", job.cells},
                  {"counters", job.counters},
                  {"p", job.params_buffer}});
    write_.launch(device_, "write_lists", cl::NDRange(blocks(p) * write_items_), cl::NDRange(write_items_),
                  {{"ids", ids_.get()},
                   {"offsets", places_.get()},
                   {"totals", totals_.get()},
                   {"marks", cell_marks_.get()},
                   {"cells", job.cells},
                   {"indices", job.indices},
                   {"counters", job.counters},
                   {"p", job.params_buffer}});
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
  NamedKernel project_, cull_, write_;
  GrowingBuffer views_, light_marks_, ids_, cell_marks_, places_, totals_;
};

}  // namespace

std::unique_ptr<CullPipeline> make_cull_cpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                     const PipelineOptions& options) {
  return std::make_unique<CullCpuPipeline>(device, programs, options);
}

std::unique_ptr<CullPipeline> make_cull_gpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                     const PipelineOptions& options) {
  return std::make_unique<CullGpuPipeline>(device, programs, options);
}

}  // namespace lightgrid
