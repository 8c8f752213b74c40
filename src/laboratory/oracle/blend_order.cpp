#include "oracle/blend_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "base/parallel.h"
#include "oracle/primary_rays.h"

namespace lightgrid::lab {
namespace {

// Triangles that share an edge, and coincident ones, differ by rounding.
constexpr double depth_rounding = 1e-12;

// Returns whether each is as near as the one drawn before it. Depth is larger where it is nearer.
bool in_order(const std::vector<PrimaryRays::Hit>& hits) {
  return std::ranges::is_sorted(
      hits, [](auto& later, auto& earlier) { return later.depth < earlier.depth - depth_rounding; });
}

}  // namespace

BlendOrder find_blend_order(const Scene& scene, const View& view, std::span<const int> drawn) {
  if (drawn.empty()) return {};
  std::map<int, size_t> place;  // by instance
  for (const int instance : drawn) place.emplace(instance, place.size());
  const PrimaryRays opaque(scene, view), blended(scene, view, RayTargets::blended);
  std::vector<BlendOrder> rows(size_t(view.height));
  parallel_for(view.height, [&](int y) {
    BlendOrder& row = rows[size_t(y)];
    SceneSurfaces surfaces(scene, view);
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec2 centre(x + 0.5, y + 0.5);
      const auto behind = opaque.at(surfaces, centre);
      std::vector<PrimaryRays::Hit> hits = blended.all_at(surfaces, centre, behind ? behind->depth : 0);
      std::erase_if(hits, [&](const PrimaryRays::Hit& hit) {
        return surfaces.base_color_at(hit.in_view, centre).a <= 0;
      });
      std::ranges::sort(hits, {}, [&](const PrimaryRays::Hit& hit) {
        return std::tuple(place.at(hit.triangle.instance), hit.triangle.triangle);
      });
      row.blended += !hits.empty();
      row.several += hits.size() > 1;
      row.wrong += !in_order(hits);
    }
  });
  BlendOrder all;
  for (const BlendOrder& row : rows) {
    all.blended += row.blended;
    all.several += row.several;
    all.wrong += row.wrong;
  }
  return all;
}

std::string describe(const BlendOrder& order) {
  return fmt::format(
      "blend order: {} of {} pixels with blended surfaces have several, and in {} of these a farther one is "
      "blended over a nearer one\n",
      order.several, order.blended, order.wrong);
}

}  // namespace lightgrid::lab
