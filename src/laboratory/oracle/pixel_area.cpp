#include "oracle/pixel_area.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"

namespace lightgrid::lab {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;

constexpr int grid = 256, surface_grid = 16;  // parts of a pixel's side

// Hammersley's point of this number, of `places` in all, a power of two: in the middle of its column and row.
ivec2 cell_of(int number, int places) {
  int reversed = 0;
  for (int bit = 1, top = places / 2; top > 0; bit *= 2, top /= 2) reversed |= number & bit ? top : 0;
  return ivec2(number, reversed) * (grid / places) + grid / places / 2;
}

View enlarged(View view, int times) {
  view.width *= times;
  view.height *= times;
  return view;
}

bool one_surface(const TriangleInView& a, const TriangleInView& b) {
  if (a.instance != b.instance || (a.turn() < 0) != (b.turn() < 0)) return false;
  const auto is_shared = [&](uint32_t vertex) { return std::ranges::count(b.vertices, vertex) > 0; };
  return std::ranges::count_if(a.vertices, is_shared) >= 2;
}

// The number of surfaces that the triangles belong to.
int count_surfaces(std::vector<TriangleInView> left) {
  int count = 0;
  for (; !left.empty(); ++count) {
    std::vector<TriangleInView> joined = {left.back()};
    left.pop_back();
    for (size_t next = 0; next < joined.size(); ++next) {
      const TriangleInView of = joined[next];
      const auto apart = std::ranges::partition(left, [&](const auto& t) { return !one_surface(of, t); });
      joined.insert(joined.end(), apart.begin(), apart.end());
      left.erase(apart.begin(), apart.end());
    }
  }
  return count;
}

}  // namespace

dvec2 place_of_area(int number) { return (dvec2(cell_of(number, places_of_area)) + 0.5) / double(grid); }

struct AreaOracle::Seen {
  ivec2 place{0};  // pixel of of_places_
  std::optional<PrimaryRays::Hit> hit;
  dvec3 position{0};  // view space, of a hit
};

AreaOracle::AreaOracle(const Scene& scene, const View& view, const LightRanges& ranges,
                       const ShadeSettings& settings, const Occlusion* occlusion)
    : scene_(scene),
      view_(view),
      of_surfaces_(enlarged(view, surface_grid)),
      of_places_(enlarged(view, grid)),
      settings_(settings),
      occlusion_(occlusion),
      lights_(lights_in_view(scene, view, ranges)),
      opaque_(scene, of_places_),
      blended_(scene, of_places_, RayTargets::blended) {}

std::vector<AreaOracle::Seen> AreaOracle::seen_at(SceneSurfaces& surfaces, uint32_t pixel, int places) const {
  const ivec2 corner = ivec2(int(pixel) % view_.width, int(pixel) / view_.width) * grid;
  std::vector<Seen> seen;
  for (int k = 0; k < places; ++k) {
    Seen& s = seen.emplace_back();
    s.place = corner + cell_of(k, places);
    s.hit = opaque_.at(surfaces, dvec2(s.place) + 0.5);
    if (s.hit) s.position = position_from_depth(of_places_, s.place.x, s.place.y, s.hit->depth);
  }
  return seen;
}

static SeenSurfaces surfaces_of(const auto& seen) {
  SeenSurfaces of{.places = int(seen.size())};
  std::vector<TriangleInView> triangles;
  std::vector<CastingTriangle> known;
  for (const auto& s : seen) {
    of.covered += s.hit.has_value();
    if (!s.hit || std::ranges::count(known, s.hit->triangle) > 0) continue;
    known.push_back(s.hit->triangle);
    triangles.push_back(s.hit->in_view);
  }
  of.surfaces = count_surfaces(std::move(triangles));
  return of;
}

std::vector<SeenSurfaces> AreaOracle::surfaces_at(std::span<const uint32_t> pixels, int places) const {
  std::vector<SeenSurfaces> found(pixels.size());
  constexpr int run = 64;
  parallel_for(int((pixels.size() + run - 1) / run), [&](int r) {
    SceneSurfaces surfaces(scene_, of_surfaces_);
    for (size_t i = size_t(r) * run; i < std::min(pixels.size(), size_t(r + 1) * run); ++i)
      found[i] = surfaces_of(seen_at(surfaces, pixels[i], places));
  });
  return found;
}

// Lights whose range meets the box around what the pixel sees.
std::vector<uint32_t> AreaOracle::lights_near(const std::vector<Seen>& seen) const {
  dvec3 least(INFINITY), most(-INFINITY);
  for (const Seen& s : seen)
    if (s.hit) {
      least = glm::min(least, s.position);
      most = glm::max(most, s.position);
    }
  std::vector<uint32_t> near;
  for (uint32_t i = 0; i < lights_.size(); ++i) {
    const ViewLight& light = lights_[i];
    const dvec3 off = light.position - glm::clamp(light.position, least, most);
    if (light.type == LightType::directional || glm::length(off) <= light.radius_m) near.push_back(i);
  }
  return near;
}

void AreaOracle::shade_area(PixelArea& area, SceneSurfaces& surfaces, const std::vector<Seen>& seen) const {
  const std::vector<uint32_t> near = lights_near(seen);
  std::vector<int> last(near.size(), -1);
  std::vector<ViewLight> lights;
  int undecided = 0;
  for (const Seen& s : seen) {
    if (!s.hit) {
      area.radiance += dvec3(scene_.background);
      continue;
    }
    const dvec2 place = (dvec2(s.place) + 0.5) * double(surface_grid) / double(grid);
    const Surface surface = surfaces.surface_at(s.hit->in_view, place);
    std::optional<Receiver> receiver;
    bool either = false;
    lights.clear();
    for (size_t k = 0; k < near.size(); ++k) {
      const ViewLight& light = lights_[near[k]];
      const Light& in_world = scene_.lights[near[k]];
      const bool directional = light.type == LightType::directional;
      if (!directional && !is_lit(light, s.position, surface.mask)) continue;
      if (occlusion_ && in_world.casts_shadow) {
        if (!receiver)
          receiver = occlusion_->receiver(of_places_, s.place.x, s.place.y, s.hit->depth, s.hit->triangle);
        const Sight sight = occlusion_->sight(in_world, *receiver, &last[k]).sight;
        either |= sight == Sight::either;
        if (sight == Sight::hidden) continue;
      }
      lights.push_back(light);
    }
    undecided += either;
    area.radiance += shade(surface, s.position, view_.orthographic, lights, settings_);
  }
  area.radiance /= double(seen.size());
  area.undecided = undecided * 100 > int(seen.size());
}

std::vector<PixelArea> AreaOracle::at(std::span<const uint32_t> pixels) const {
  std::vector<PixelArea> areas(pixels.size());
  constexpr int run = 8;
  parallel_for(int((pixels.size() + run - 1) / run), [&](int r) {
    SceneSurfaces surfaces(scene_, of_surfaces_);
    for (size_t i = size_t(r) * run; i < std::min(pixels.size(), size_t(r + 1) * run); ++i) {
      const std::vector<Seen> seen = seen_at(surfaces, pixels[i], places_of_area);
      PixelArea& area = areas[i];
      area.at_edge = surfaces_of(seen).at_edge();
      area.blended = std::ranges::any_of(seen, [&](const Seen& s) {
        const auto over = blended_.at(surfaces, dvec2(s.place) + 0.5);
        return over && (!s.hit || over->depth >= s.hit->depth);
      });
      if (!area.blended) shade_area(area, surfaces, seen);
    }
  });
  return areas;
}

}  // namespace lightgrid::lab
