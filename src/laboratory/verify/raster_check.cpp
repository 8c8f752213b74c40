#include "verify/raster_check.h"

#include <array>
#include <map>

#include "base/facing.h"
#include "oracle/coverage.h"

namespace lightgrid::verify {
namespace {

// From the centre, 1/16 pixel, y down: as Vulkan 1.3 lists its standard sample locations, (x - 0.5, y - 0.5)
// * 16.
const std::map<int, std::vector<std::array<int, 2>>>& listed_places() {
  static const std::map<int, std::vector<std::array<int, 2>>> all = {
      {1, {{0, 0}}},
      {2, {{4, 4}, {-4, -4}}},
      {4, {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}}},
      {8, {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}}};
  return all;
}

CoverageOracle raster_oracle(const RasterInput& input, const RasterImage& image, std::array<int, 2> place) {
  CoverageOracle oracle(input.camera.grid, {128 + 16 * place[0], 128 - 16 * place[1]});
  for (size_t i = 0; i < input.instances.size(); ++i) {
    const RasterInstance& instance = input.instances[i];
    const std::vector<uint32_t>& indices = input.meshes[instance.mesh].indices;
    const std::vector<glm::vec4>& clip = image.clip[i];
    const bool mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
    for (size_t k = 0; k < indices.size(); k += 3) {
      oracle.add(
          {{clip[indices[k]], clip[indices[k + 1]], clip[indices[k + 2]]}, instance.two_sided, mirrored});
    }
  }
  return oracle;
}

// One trial and one contact a sample; a hole is a lost one.
void compare_raster(Check& c, const RasterInput& input, const RasterImage& image) {
  const PixelGrid& grid = input.camera.grid;
  const std::vector<std::array<int, 2>>& places = listed_places().at(grid.samples);
  for (int s = 0; s < grid.samples; ++s) {
    const CoverageOracle oracle = raster_oracle(input, image, places[size_t(s)]);
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const size_t i = grid.index(x, y, s);
        const std::string why = wrong_at(oracle.at(x, y), image.triangles[i], image.depths[i]);
        c.trials(1);
        c.contacts(!oracle.at(x, y).empty());
        if (why.empty()) continue;
        if (image.triangles[i] == no_triangle)
          c.lost("pixel {} {}, sample {}: {}", x, y, s, why);
        else
          c.fail(fmt::format("pixel {} {}, sample {}: {}", x, y, s, why));
      }
    }
    c.that(image.invalid_triangles == oracle.invalid_triangles(), "{} triangles are called invalid, {} are",
           image.invalid_triangles, oracle.invalid_triangles());
  }
}

}  // namespace

std::optional<RasterImage> raster(Check& c, const RasterInput& input) {
  std::optional<RasterImage> first;
  for (const RasterOptions& options :
       {RasterOptions{.shape = KernelShape::lanes}, RasterOptions{.shape = KernelShape::group},
        RasterOptions{.shape = KernelShape::group, .wide_atomics = false}}) {
    std::optional<RasterImage> image = c.engine.rasterize(options, input);
    if (!image) {
      c.skip("the engine does not rasterise");
      return {};
    }
    if (!first) {
      compare_raster(c, input, *image);
      first = std::move(image);
    } else {
      c.that(image->triangles == first->triangles && image->depths == first->depths,
             "the kernel shapes' images differ");
    }
    if (!c.engine.has_both_shapes()) break;
  }
  return first;
}

}  // namespace lightgrid::verify
