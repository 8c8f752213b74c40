#include "passes/tile_masks.h"

#include "cl/launch.h"
#include "shared/light_grid.h"

namespace lightgrid {

// The kernel's masks and its result.
class TileMasks : public PassCache {
 public:
  explicit TileMasks(PassContext& work) { follow(work); }

  bool follow(PassContext& work) override {
    masks_.put(*work.renderer.cl, "uploading masks of surfaces", work.plan.masks.values);
    return true;
  }

  size_t memory_bytes() const override { return masks_.bytes() + masks_of_tiles_.bytes(); }

  cl::Buffer find(PassContext& work, const CullParams& tiles, const std::string& defines,
                  const ClArguments& surfaces, size_t bytes_a_pixel) {
    const size_t all = size_t(tiles.bins_x) * tiles.bins_y * BIN_SIZE;
    ClDevice& device = *work.renderer.cl;
    if (!kernel_ || defines != defines_)
      kernel_ = NamedKernel(*work.renderer.kernels, "culling/tile_masks", defines);
    defines_ = defines;
    auto pass = work.timer.pass("tile_groups", "cl");
    kernel_.launch(
        device, "tile_masks", cl::NDRange(all), cl::NullRange,
        surfaces + ClArguments{{"masks", masks_.buffer()},
                               {"last", cl_uint(work.plan.masks.values.size() - 1)},
                               {"tile_masks", masks_of_tiles_.at_least(device, all * sizeof(cl_uint))},
                               {"width", cl_uint(tiles.width)},
                               {"height", cl_uint(tiles.height)},
                               {"tile", cl_uint(tiles.tile_size)},
                               {"bins_x", cl_uint(tiles.bins_x)}});
    pass.moves(work.grid().values() * bytes_a_pixel, all * sizeof(cl_uint));
    return masks_of_tiles_.get();
  }

 private:
  UploadedBuffer masks_;
  GrowingBuffer masks_of_tiles_;
  NamedKernel kernel_;
  std::string defines_;
};

cl::Buffer tile_masks(PassContext& work, Cached<TileMasks>& cache, const CullParams& tiles,
                      const VisibilityBuffer& visible) {
  return cache.of(work).find(work, tiles, fmt::format("-DTRIANGLES -DSAMPLES={}u", work.grid().samples),
                             ClArguments{{"triangles", visible.image.triangle},
                                         {"triangle_instance", visible.raster.triangle_instance},
                                         {"surfaces", visible.surfaces}},
                             4);
}

cl::Buffer tile_masks(PassContext& work, Cached<TileMasks>& cache, const CullParams& tiles,
                      SharedBuffer& numbers, const DepthBuffer& depth) {
  const SurfaceNumberFormat& format = surface_number_format(work.plan.settings);
  return cache.of(work).find(
      work, tiles, fmt::format("-DNUMBER_BITS={} -DSAMPLES={}u", format.bits, work.grid().samples),
      ClArguments{{"numbers", numbers.cl_buffer()}, {"depths", depth.values}}, format.bytes + 4);
}

}  // namespace lightgrid
