// transform, clusters -> order -> setup -> scan -> fill -> tiles: for CPUs. Without tiles also for GPUs,
// where lists have to be in drawing order.
#include <algorithm>

#include "cl/launch.h"
#include "cl/transfer.h"
#include "raster/raster_pipeline.h"

namespace lightgrid {
namespace {

constexpr uint32_t chunks_a_unit = 8, most_chunks = 64;   // enough to share out evenly
constexpr uint32_t most_tile_counts = uint32_t(1) << 24;  // of all chunks
constexpr uint32_t clusters_an_item = 256;

class RasterLanesPipeline : public RasterPipeline {
 public:
  RasterLanesPipeline(ClDevice& device, ProgramCache& programs, bool portable)
      : device_(device), programs_(programs), defines_(portable ? "-DPORTABLE" : "") {
    transform_ = programs.kernel("raster/cpu/raster_transform", "");
    clusters_ = programs.kernel("raster/cpu/raster_clusters", "");
    order_ = programs.kernel("raster/cpu/raster_order", "");
    setup_ = programs.kernel("raster/cpu/raster_setup", defines_);
    scan_ = programs.kernel(device.info().cpu ? "raster/cpu/raster_scan" : "raster/gpu/raster_scan", "");
    fill_ = programs.kernel("raster/cpu/raster_fill", "");
  }

  uint32_t chunks(const RasterParams& p) const override {
    const uint32_t units = uint32_t(std::max(1, device_.info().compute_units));
    const uint32_t most =
        std::min({units * chunks_a_unit, most_chunks, most_tile_counts / (p.tiles_x * p.tiles_y)});
    return std::clamp<uint32_t>(p.pairs, 1, std::max<uint32_t>(1, most));
  }

  void prepare(const RasterParams& p) override {
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
      launch(device_, "raster_transform", transform_,
             cl::NDRange(std::min<size_t>(p.vertex_runs, units * 16)), one, job.positions, job.vertex_runs,
             job.instances, job.frame, job.clip, job.params_buffer);
    }
    launch(device_, "raster_clusters", clusters_,
           cl::NDRange(std::clamp<size_t>(p.pairs / clusters_an_item, 1, units * 16)), one, job.pairs,
           job.clusters, job.frame, buckets_.get(), job.params_buffer);
    launch(device_, "raster_order", order_, one, one, buckets_.get(), visible_.get(), job.counters,
           job.params_buffer);
    launch(device_, "raster_setup", setup_, cl::NDRange(p.chunks), one, visible_.get(), job.pairs,
           job.clusters, job.instances, job.cluster_indices, job.cluster_triangles, job.clip, records_.get(),
           next_block_.get(), chunks_.get(), tile_counts_.get(), job.counters, job.params_buffer);
    const cl::NDRange adders(device_.info().cpu ? 1 : RASTER_SCAN_GROUP);
    launch(device_, "raster_scan", scan_, adders, adders, tile_counts_.get(), tile_begin_.get(), job.counters,
           job.params_buffer);
    launch(device_, "raster_fill", fill_, cl::NDRange(p.chunks), one, records_.get(), next_block_.get(),
           chunks_.get(), tile_counts_.get(), lists_.get(), job.counters, job.params_buffer);
    if (!job.triangles()) return;
    launch(device_, "raster_tiles", tiles_kernel(job.masks.alphas() != nullptr),
           cl::NDRange(std::min(tiles, units)), one, records_.get(), tile_begin_.get(), lists_.get(),
           job.instances, job.indices, job.clip, job.masks.vertices, job.masks.materials, job.masks.alphas,
           job.triangles, job.depths, job.counters, job.params_buffer);
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
  cl::Kernel& tiles_kernel(bool masks) {
    cl::Kernel& kernel = tiles_[masks];
    if (!kernel()) {
      kernel = programs_.kernel("raster/cpu/raster_tiles", defines_ + (masks ? " -DALPHA_MASKS" : ""));
    }
    return kernel;
  }

  ClDevice& device_;
  ProgramCache& programs_;
  const std::string defines_;
  cl::Kernel transform_, clusters_, order_, setup_, scan_, fill_, tiles_[2];
  GrowingBuffer buckets_, visible_, records_, next_block_, chunks_, tile_counts_, tile_begin_, lists_;
};

}  // namespace

std::unique_ptr<RasterPipeline> make_raster_lanes_pipeline(ClDevice& device, ProgramCache& programs,
                                                           bool portable) {
  return std::make_unique<RasterLanesPipeline>(device, programs, portable);
}

}  // namespace lightgrid
