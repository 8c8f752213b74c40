#include "compare/edge_share.h"

#include <fmt/format.h>

#include <numeric>

#include "oracle/pixel_area.h"

namespace lightgrid {

EdgeShare find_edge_share(const Scene& scene, const View& view, int samples, size_t most) {
  std::vector<uint32_t> all(view.grid().pixels());
  std::iota(all.begin(), all.end(), 0u);
  const AreaOracle oracle(scene, view, {}, {}, nullptr);
  EdgeShare share{.samples = samples};
  for (const SeenSurfaces& seen : oracle.surfaces_at(sample_pixels(all, most), samples)) {
    ++share.pixels;
    share.edges += seen.at_edge();
    share.covered += uint64_t(seen.covered), share.shaded += uint64_t(seen.surfaces);
  }
  return share;
}

std::string describe(const EdgeShare& s, const View& view) {
  const double of_pixels = double(s.edges) / double(s.pixels);
  return fmt::format(
      "pixels with edges: {:.1f} % of {} sampled, about {:.0f} of {} with samples={}\n"
      "  shading each surface once a pixel takes {:.2f} shadings a sample: it saves {:.0f} %\n",
      100 * of_pixels, s.pixels, of_pixels * double(view.grid().pixels()), view.grid().pixels(), s.samples,
      1 - s.saved(), 100 * s.saved());
}

}  // namespace lightgrid
