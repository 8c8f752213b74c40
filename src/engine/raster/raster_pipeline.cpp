// transform, clusters -> order -> setup -> scan -> fill -> tiles: for CPUs. Without tiles also for GPUs,
// where lists have to be in drawing order.
// transform, clusters -> small -> large -> keys: for GPUs. With 32-bit atomics small and large run twice.
#include "raster/raster_arrays.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "cl/launch.h"
#include "cl/transfer.h"
#include "raster/raster_samples.h"

namespace lightgrid {
namespace {

constexpr uint32_t chunks_a_unit = 8, max_chunks = 64;   // enough to share out evenly
constexpr uint32_t max_tile_counts = uint32_t(1) << 24;  // over all chunks
constexpr uint32_t clusters_an_item = 256;

std::string alpha_masks(SampleMasks masks) {
  const std::string at = mask_define(masks);
  return " -DALPHA_MASKS" + (at.empty() ? "" : " -D" + at);
}

class RasterCpuPipeline : public RasterPipeline {
 public:
  RasterCpuPipeline(ClDevice& device, ProgramCache& programs, bool portable, SampleMasks masks)
      : device_(device),
        programs_(programs),
        defines_(portable ? "-DPORTABLE" : ""),
        masks_(alpha_masks(masks)) {
    transform_ = NamedKernel(programs, "raster/cpu/raster_transform", "");
    clusters_ = NamedKernel(programs, "raster/cpu/raster_clusters", "");
    order_ = NamedKernel(programs, "raster/cpu/raster_order", "");
    scan_ =
        NamedKernel(programs, device.info().cpu ? "raster/cpu/raster_scan" : "raster/gpu/raster_scan", "");
  }

  uint32_t chunks(const RasterParams& p) const override {
    const uint32_t units = uint32_t(std::max(1, device_.info().compute_units));
    const uint32_t most =
        std::min({units * chunks_a_unit, max_chunks, max_tile_counts / (p.tiles_x * p.tiles_y)});
    return std::clamp<uint32_t>(p.pairs, 1, std::max<uint32_t>(1, most));
  }

  void prepare(const RasterParams& p, int) override {
    const size_t tiles = size_t(p.tiles_x) * p.tiles_y;
    buckets_.at_least(device_, p.pairs);
    visible_.at_least(device_, size_t(p.pairs) * sizeof(cl_uint));
    records_.at_least(device_, size_t(p.record_blocks) * RASTER_BLOCK * sizeof(RasterRecord));
    next_block_.at_least(device_, size_t(p.record_blocks) * sizeof(cl_uint));
    chunks_.at_least(device_, size_t(p.chunks) * sizeof(cl_uint2));
    tile_counts_.at_least(device_, p.chunks * tiles * sizeof(cl_uint));
    tile_begin_.at_least(device_, (tiles + 1) * sizeof(cl_uint));
    lists_.at_least(device_, size_t(p.entry_capacity) * sizeof(cl_uint));
  }

  void enqueue(const RasterJob& job) override {
    const RasterParams& p = job.params;
    const cl::NDRange one(1);
    const size_t units = size_t(std::max(1, device_.info().compute_units)),
                 tiles = size_t(p.tiles_x) * p.tiles_y;
    fill_buffer(device_, "rasterizer: counters", job.counters, 0, RASTER_COUNTERS * sizeof(cl_uint));
    if (p.vertex_runs != 0) {
      transform_.launch(device_, "raster_transform", cl::NDRange(std::min<size_t>(p.vertex_runs, units * 16)),
                        one,
                        {{"positions", job.positions},
                         {"runs", job.vertex_runs},
                         {"instances", job.instances},
                         {"frame", job.frame},
                         {"clip", job.clip},
                         {"p", job.params_buffer}});
    }
    clusters_.launch(device_, "raster_clusters",
                     cl::NDRange(std::clamp<size_t>(p.pairs / clusters_an_item, 1, units * 16)), one,
                     {{"pairs", job.pairs},
                      {"clusters", job.clusters},
                      {"frame", job.frame},
                      {"buckets", buckets_.get()},
                      {"p", job.params_buffer}});
    order_.launch(device_, "raster_order", one, one,
                  {{"buckets", buckets_.get()},
                   {"visible", visible_.get()},
                   {"counters", job.counters},
                   {"p", job.params_buffer}});
    kernel("raster_setup", job)
        .launch(device_, "raster_setup", cl::NDRange(p.chunks), one,
                {{"visible", visible_.get()},
                 {"pairs", job.pairs},
                 {"clusters", job.clusters},
                 {"instances", job.instances},
                 {"indices", job.cluster_indices},
                 {"numbers", job.cluster_triangles},
                 {"clip", job.clip},
                 {"records", records_.get()},
                 {"next_block", next_block_.get()},
                 {"chunks", chunks_.get()},
                 {"tile_counts", tile_counts_.get()},
                 {"counters", job.counters},
                 {"p", job.params_buffer}});
    const cl::NDRange adders(device_.info().cpu ? 1 : RASTER_SCAN_GROUP);
    scan_.launch(device_, "raster_scan", adders, adders,
                 {{"tile_counts", tile_counts_.get()},
                  {"tile_begin", tile_begin_.get()},
                  {"counters", job.counters},
                  {"p", job.params_buffer}});
    kernel("raster_fill", job)
        .launch(device_, "raster_fill", cl::NDRange(p.chunks), one,
                {{"records", records_.get()},
                 {"next_block", next_block_.get()},
                 {"chunks", chunks_.get()},
                 {"tile_at", tile_counts_.get()},
                 {"lists", lists_.get()},
                 {"counters", job.counters},
                 {"p", job.params_buffer}});
    if (!job.triangles()) return;
    kernel("raster_tiles", job, job.masks.alphas() ? masks_ : "")
        .launch(device_, "raster_tiles", cl::NDRange(std::min(tiles, units)), one,
                {{"records", records_.get()},
                 {"tile_begin", tile_begin_.get()},
                 {"lists", lists_.get()},
                 {"mask_instances", job.instances},
                 {"mask_indices", job.indices},
                 {"mask_clip", job.clip},
                 {"mask_vertices", job.masks.vertices},
                 {"mask_materials", job.masks.materials},
                 {"mask_alphas", job.masks.alphas},
                 {"triangles", job.triangles},
                 {"depths", job.depths},
                 {"counters", job.counters},
                 {"p", job.params_buffer}});
  }

  RasterLists lists(const RasterParams& p) const override {
    return {records_.get(), tile_begin_.get(), lists_.get(), p.tiles_x, p.tiles_y};
  }

  size_t memory_bytes() const override {
    return buckets_.bytes() + visible_.bytes() + records_.bytes() + next_block_.bytes() + chunks_.bytes() +
           tile_counts_.bytes() + tile_begin_.bytes() + lists_.bytes();
  }

 private:
  // Built at first use.
  NamedKernel& kernel(const char* name, const RasterJob& job, const std::string& more = "") {
    NamedKernel& kernel = kernels_[{name, job.samples, !more.empty()}];
    if (!kernel)
      kernel = NamedKernel(programs_, std::string("raster/cpu/") + name,
                           defines_ + sample_defines(job.samples) + more);
    return kernel;
  }

  ClDevice& device_;
  ProgramCache& programs_;
  const std::string defines_, masks_;
  NamedKernel transform_, clusters_, order_, scan_;
  std::map<std::tuple<std::string, int, bool>, NamedKernel> kernels_;  // by samples and masks
  GrowingBuffer buckets_, visible_, records_, next_block_, chunks_, tile_counts_, tile_begin_, lists_;
};

constexpr size_t group_items = 64, groups_a_unit = 32;
constexpr size_t image_group = 256;  // for kernels with little work per pixel: groups of 64 start too slowly

bool has_64_bit_atomics(ClDevice& device) {
  return device.device().getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_int64_extended_atomics") !=
         std::string::npos;
}

cl::NDRange items_for(size_t count, size_t group = group_items) {
  return cl::NDRange(std::max<size_t>(1, (count + group - 1) / group) * group);
}

size_t pairs_of(size_t pixels) { return (pixels + 1) / 2; }

class RasterGpuPipeline : public RasterPipeline {
 public:
  RasterGpuPipeline(ClDevice& device, ProgramCache& programs, bool wide_atomics, SampleMasks masks)
      : device_(device),
        programs_(programs),
        wide_(wide_atomics && has_64_bit_atomics(device)),
        masks_(alpha_masks(masks)) {
    transform_ = NamedKernel(programs, "raster/gpu/raster_transform", "");
    clusters_ = NamedKernel(programs, "raster/gpu/raster_clusters", "");
    if (!wide_) return;
    clear_ = NamedKernel(programs, "raster/gpu/raster_clear", "");
    keys_kernel_ = NamedKernel(programs, "raster/gpu/raster_keys", "");
  }

  uint32_t chunks(const RasterParams&) const override { return 1; }

  void prepare(const RasterParams& p, int samples) override {
    visible_.at_least(device_, size_t(p.pairs) * sizeof(cl_uint));
    records_.at_least(device_, size_t(p.record_blocks) * RASTER_BLOCK * sizeof(RasterRecord));
    entries_.at_least(device_, size_t(p.entry_capacity) * sizeof(cl_uint2));
    keys_.at_least(device_, wide_ ? pairs_of(size_t(p.width) * p.height * samples) * sizeof(cl_ulong2) : 0);
  }

  void enqueue(const RasterJob& job) override {
    const RasterParams& p = job.params;
    const size_t values = size_t(p.width) * p.height * job.samples;
    const cl::NDRange group(group_items);
    const cl::NDRange all(size_t(std::max(1, device_.info().compute_units)) * groups_a_unit * group_items);
    fill_buffer(device_, "rasterizer: counters", job.counters, 0, RASTER_COUNTERS * sizeof(cl_uint));
    if (wide_) {
      clear_.launch(device_, "raster_clear", items_for(pairs_of(values), image_group),
                    cl::NDRange(image_group), {{"keys", keys_.get()}, {"pairs", cl_uint(pairs_of(values))}});
    } else {
      fill_buffer(device_, "rasterizer: image", job.triangles, RASTER_NONE, values * sizeof(cl_uint));
      fill_buffer(device_, "rasterizer: image", job.depths, 0, values * sizeof(cl_uint));
    }
    transform_.launch(device_, "raster_transform", items_for(size_t(p.vertex_runs) * RASTER_VERTEX_RUN),
                      group,
                      {{"positions", job.positions},
                       {"runs", job.vertex_runs},
                       {"instances", job.instances},
                       {"frame", job.frame},
                       {"clip", job.clip},
                       {"p", job.params_buffer}});
    clusters_.launch(device_, "raster_clusters", items_for(p.pairs), group,
                     {{"pairs", job.pairs},
                      {"clusters", job.clusters},
                      {"frame", job.frame},
                      {"visible", visible_.get()},
                      {"counters", job.counters},
                      {"p", job.params_buffer}});
    // The second pass needs the depths of all triangles.
    for (int pass = 0; pass < (wide_ ? 1 : 2); ++pass) {
      kernel("raster_small", pass, job)
          .launch(device_, "raster_small", all, group,
                  {{"visible", visible_.get()},
                   {"pairs", job.pairs},
                   {"clusters", job.clusters},
                   {"instances", job.instances},
                   {"indices", job.cluster_indices},
                   {"numbers", job.cluster_triangles},
                   {"clip", job.clip},
                   {"mask_instances", job.instances},
                   {"mask_indices", job.indices},
                   {"mask_clip", job.clip},
                   {"mask_vertices", job.masks.vertices},
                   {"mask_materials", job.masks.materials},
                   {"mask_alphas", job.masks.alphas},
                   {"records", records_.get()},
                   {"entries", entries_.get()},
                   {"keys", keys_.get()},
                   {"triangles", job.triangles},
                   {"depths", job.depths},
                   {"counters", job.counters},
                   {"p", job.params_buffer}});
      kernel("raster_large", pass, job)
          .launch(device_, "raster_large", all, group,
                  {{"records", records_.get()},
                   {"entries", entries_.get()},
                   {"mask_instances", job.instances},
                   {"mask_indices", job.indices},
                   {"mask_clip", job.clip},
                   {"mask_vertices", job.masks.vertices},
                   {"mask_materials", job.masks.materials},
                   {"mask_alphas", job.masks.alphas},
                   {"keys", keys_.get()},
                   {"triangles", job.triangles},
                   {"depths", job.depths},
                   {"counters", job.counters},
                   {"p", job.params_buffer}});
    }
    if (wide_) {
      keys_kernel_.launch(device_, "raster_keys", items_for(values, image_group), cl::NDRange(image_group),
                          {{"keys", keys_.get()},
                           {"triangles", job.triangles},
                           {"depths", job.depths},
                           {"samples", cl_uint(values)}});
    }
  }

  // Its records are in no order.
  RasterLists lists(const RasterParams&) const override { return {}; }

  size_t memory_bytes() const override {
    return visible_.bytes() + records_.bytes() + entries_.bytes() + keys_.bytes();
  }

 private:
  // Built at first use.
  NamedKernel& kernel(const char* name, int pass, const RasterJob& job) {
    const bool masks = job.masks.alphas() != nullptr;
    NamedKernel& kernel = kernels_[{name, job.samples, pass, masks}];
    if (kernel) return kernel;
    std::string defines = wide_       ? "-DATOMICS=64"
                          : pass == 0 ? "-DATOMICS=32 -DPASS=1"
                                      : "-DATOMICS=32 -DPASS=2";
    if (masks) defines += masks_;
    return kernel = NamedKernel(programs_, std::string("raster/gpu/") + name,
                                defines + sample_defines(job.samples));
  }

  ClDevice& device_;
  ProgramCache& programs_;
  const bool wide_;
  const std::string masks_;
  NamedKernel transform_, clusters_, clear_, keys_kernel_;
  std::map<std::tuple<std::string, int, int, bool>, NamedKernel> kernels_;  // by samples, pass and masks
  GrowingBuffer visible_, records_, entries_, keys_;
};

}  // namespace

std::unique_ptr<RasterPipeline> make_raster_cpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool portable, SampleMasks masks) {
  return std::make_unique<RasterCpuPipeline>(device, programs, portable, masks);
}

std::unique_ptr<RasterPipeline> make_raster_gpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool wide_atomics, SampleMasks masks) {
  return std::make_unique<RasterGpuPipeline>(device, programs, wide_atomics, masks);
}

}  // namespace lightgrid
