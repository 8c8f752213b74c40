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

struct AreaOracle::Hit {
  PrimaryRays::Hit of;
  ivec2 place{0};     // pixel of of_places_
  dvec3 position{0};  // view space
};

struct AreaOracle::Seen {
  ivec2 place{0};
  std::optional<Hit> hit;  // none: the background
  std::vector<Hit> over;   // blended, the farthest first
};

struct AreaOracle::NearLights {
  std::vector<uint32_t> numbers;
  std::vector<int> last;  // of each, the triangle that hid it last
};

struct AreaOracle::Shaded {
  dvec3 radiance{0}, doubt{0};
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

AreaOracle::Hit AreaOracle::hit_of(const PrimaryRays::Hit& hit, const ivec2& place) const {
  return {hit, place, position_from_depth(of_places_, place.x, place.y, hit.depth)};
}

std::vector<AreaOracle::Seen> AreaOracle::seen_at(SceneSurfaces& surfaces, uint32_t pixel, int places) const {
  const ivec2 corner = ivec2(int(pixel) % view_.width, int(pixel) / view_.width) * grid;
  std::vector<Seen> seen;
  for (int k = 0; k < places; ++k) {
    Seen& s = seen.emplace_back();
    s.place = corner + cell_of(k, places);
    if (const auto hit = opaque_.at(surfaces, dvec2(s.place) + 0.5)) s.hit = hit_of(*hit, s.place);
  }
  return seen;
}

static SeenSurfaces surfaces_of(const auto& seen) {
  SeenSurfaces of{.places = int(seen.size())};
  std::vector<TriangleInView> triangles;
  std::vector<CastingTriangle> known;
  for (const auto& s : seen) {
    of.covered += s.hit.has_value();
    if (!s.hit || std::ranges::count(known, s.hit->of.triangle) > 0) continue;
    known.push_back(s.hit->of.triangle);
    triangles.push_back(s.hit->of.in_view);
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
AreaOracle::NearLights AreaOracle::lights_near(const std::vector<Seen>& seen) const {
  dvec3 least(INFINITY), most(-INFINITY);
  const auto add = [&](const Hit& hit) {
    least = glm::min(least, hit.position);
    most = glm::max(most, hit.position);
  };
  for (const Seen& s : seen) {
    if (s.hit) add(*s.hit);
    std::ranges::for_each(s.over, add);
  }
  NearLights near;
  for (uint32_t i = 0; i < lights_.size(); ++i) {
    const ViewLight& light = lights_[i];
    const dvec3 off = light.position - glm::clamp(light.position, least, most);
    if (light.type == LightType::directional || glm::length(off) <= light.radius_m) near.numbers.push_back(i);
  }
  near.last.assign(near.numbers.size(), -1);
  return near;
}

AreaOracle::Shaded AreaOracle::shade_hit(const Hit& hit, SceneSurfaces& surfaces, NearLights& near) const {
  const dvec2 place = (dvec2(hit.place) + 0.5) * double(surface_grid) / double(grid);
  const Surface surface = surfaces.surface_at(hit.of.in_view, place);
  std::optional<Receiver> receiver;
  std::vector<ViewLight> lights, doubtful;
  for (size_t k = 0; k < near.numbers.size(); ++k) {
    const ViewLight& light = lights_[near.numbers[k]];
    const Light& in_world = scene_.lights[near.numbers[k]];
    const bool directional = light.type == LightType::directional;
    if (!directional && !is_lit(light, hit.position, surface.mask)) continue;
    Sight sight = Sight::seen;
    if (occlusion_ && in_world.casts_shadow) {
      if (!receiver)
        receiver = occlusion_->receiver(of_places_, hit.place.x, hit.place.y, hit.of.depth, hit.of.triangle);
      sight = occlusion_->sight(in_world, *receiver, &near.last[k]).sight;
    }
    if (sight == Sight::hidden) continue;
    if (sight == Sight::either) doubtful.push_back(light);
    lights.push_back(light);
  }
  Shaded shaded{shade(surface, hit.position, view_.orthographic, lights, settings_)};
  if (!doubtful.empty())
    shaded.doubt = shade(surface, hit.position, view_.orthographic, doubtful, settings_) -
                   shade(surface, hit.position, view_.orthographic, {}, settings_);
  return shaded;
}

dvec3 AreaOracle::background_at(const ivec2& place) const {
  if (!settings_.background) return dvec3(scene_.background);
  if (view_.orthographic) return settings_.background({0, 0, -1});
  return settings_.background(glm::normalize(position_from_depth(of_places_, place.x, place.y, 1)));
}

void AreaOracle::shade_area(PixelArea& area, SceneSurfaces& surfaces, const std::vector<Seen>& seen) const {
  NearLights near = lights_near(seen);
  const double count = double(seen.size());
  int undecided = 0;
  dvec3 squares(0);
  for (const Seen& s : seen) {
    Shaded shown = s.hit ? shade_hit(*s.hit, surfaces, near) : Shaded{background_at(s.place)};
    for (const Hit& hit : s.over) {
      const Shaded own = shade_hit(hit, surfaces, near);
      const dvec2 place = (dvec2(hit.place) + 0.5) * double(surface_grid) / double(grid);
      const double alpha = surfaces.base_color_at(hit.of.in_view, place).a;
      shown.radiance = glm::mix(shown.radiance, own.radiance, alpha);
      shown.doubt = glm::mix(shown.doubt, own.doubt, alpha);
    }
    undecided += shown.doubt != dvec3(0);
    area.radiance += shown.radiance / count;
    area.doubt += shown.doubt / count;
    squares += shown.radiance * shown.radiance / count;
  }
  area.undecided = undecided * 100 > int(seen.size());
  const dvec3 variance = glm::max(squares - area.radiance * area.radiance, dvec3(0));
  area.spread = glm::sqrt(variance / count);
}

std::vector<PixelArea> AreaOracle::at(std::span<const uint32_t> pixels, int places) const {
  std::vector<PixelArea> areas(pixels.size());
  constexpr int run = 8;
  parallel_for(int((pixels.size() + run - 1) / run), [&](int r) {
    SceneSurfaces surfaces(scene_, of_surfaces_);
    for (size_t i = size_t(r) * run; i < std::min(pixels.size(), size_t(r + 1) * run); ++i) {
      std::vector<Seen> seen = seen_at(surfaces, pixels[i], places);
      PixelArea& area = areas[i];
      area.at_edge = surfaces_of(seen).at_edge();
      for (Seen& s : seen) {
        const double nearest = s.hit ? s.hit->of.depth : 0;
        for (const auto& over : blended_.all_at(surfaces, dvec2(s.place) + 0.5, nearest))
          s.over.push_back(hit_of(over, s.place));
        area.blended |= !s.over.empty();
      }
      shade_area(area, surfaces, seen);
    }
  });
  return areas;
}

}  // namespace lightgrid::lab
