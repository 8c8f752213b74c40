// Hard cases of lists that end at a number of lights: lights that are alike, of every brightness, at the eye
// and on surfaces. Which lights have to be kept is chosen in double, from the lists without a limit.
#include <algorithm>
#include <cmath>

#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "scene/view_lights.h"
#include "verify/check.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;

std::span<const uint32_t> list_at(const ListedLights& lists, size_t pixel) {
  const size_t cell = lists.cell_of_pixel[pixel];
  return std::span(lists.indices).subspan(lists.first[cell], lists.count[cell]);
}

// The distances from the nearest surface of a tile to its farthest.
struct Tile {
  int x0, y0, x1, y1;
  double near = 1e18, far = -1e18;
};

Tile tile_at(const View& view, const GroupImage& image, size_t pixel) {
  const int x = int(pixel) % view.width / image.tile * image.tile,
            y = int(pixel) / view.width / image.tile * image.tile;
  Tile tile{x, y, std::min(x + image.tile, view.width), std::min(y + image.tile, view.height)};
  for (int py = tile.y0; py < tile.y1; ++py) {
    for (int px = tile.x0; px < tile.x1; ++px) {
      const float depth = image.depths[size_t(py) * size_t(view.width) + size_t(px)];
      if (!(depth > 0)) continue;
      const double distance = -lab::position_from_depth(view, px, py, depth).z;
      tile.near = std::min(tile.near, distance);
      tile.far = std::max(tile.far, distance);
    }
  }
  return tile;
}

// Squared distance over intensity, least first: to where the tile's middle ray is as far away as the light.
double dimness(const View& view, const Tile& tile, const ViewLight& light) {
  const double d = std::clamp(-light.position.z, tile.near, tile.far), scale = view.orthographic ? 1 : d;
  const dvec3 at(view_x_of_pixel(view, 0.5 * (tile.x0 + tile.x1)) * scale,
                 view_y_of_pixel(view, 0.5 * (tile.y0 + tile.y1)) * scale, -d);
  const dvec3 away = light.position - at, i = light.radiant_intensity;
  return glm::dot(away, away) / (i.r + i.g + i.b);
}

// The lights of `all` that a list of `cap` keeps: of equal keys the first.
template <typename Key>
std::vector<uint32_t> least(std::span<const uint32_t> all, int cap, const Key& key) {
  std::vector<uint32_t> kept(all.begin(), all.end());
  std::ranges::stable_sort(kept, {}, key);
  kept.resize(std::min(kept.size(), size_t(cap)));
  std::ranges::sort(kept);
  return kept;
}

// Kernels round keys to float, and depth intervals outwards: a light of nearly the last key may stand for
// another.
bool as_dim(std::span<const uint32_t> kept, std::span<const uint32_t> expected, const auto& key) {
  if (kept.size() != expected.size()) return false;
  double max_kept = 0, max_expected = 0;
  for (const uint32_t light : kept) max_kept = std::max(max_kept, key(light));
  for (const uint32_t light : expected) max_expected = std::max(max_expected, key(light));
  return max_kept <= max_expected * 1.001 + 1e-9 || std::isinf(max_expected);
}

struct CapTrials {
  uint64_t entries = 0, shortened = 0, wrong = 0;
};

// alike: no two keys are nearly equal but for those that are equal, so that lists are known to the light.
CapTrials compared(const Scene& scene, const View& view, const GroupImage& whole, const GroupImage& capped,
                   const Settings& settings, bool alike) {
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  CapTrials trials;
  size_t tile_of = SIZE_MAX;
  Tile tile{};
  for (size_t pixel = 0; pixel < whole.depths.size(); ++pixel) {
    if (!(whole.depths[pixel] > 0)) continue;
    const std::span<const uint32_t> all = list_at(whole.lists, pixel), kept = list_at(capped.lists, pixel);
    trials.entries += all.size();
    trials.shortened += kept.size() < all.size();
    const size_t here = pixel / size_t(view.width) / size_t(whole.tile) * 100000 +
                        pixel % size_t(view.width) / size_t(whole.tile);
    if (here != tile_of) {
      tile = tile_at(view, whole, pixel);
      tile_of = here;
    }
    const auto by_index = [](uint32_t i) { return double(i); };
    const auto by_distance = [&](uint32_t i) { return glm::dot(lights[i].position, lights[i].position); };
    const auto by_dimness = [&](uint32_t i) { return dimness(view, tile, lights[i]); };
    bool right = std::ranges::is_sorted(kept) && std::ranges::includes(all, kept);
    if (settings[setting::list_cap_order] == ListCapOrder::index)
      right &= std::ranges::equal(kept, least(all, settings[setting::list_cap], by_index));
    if (settings[setting::list_cap_order] == ListCapOrder::distance)
      right &= std::ranges::equal(kept, least(all, settings[setting::list_cap], by_distance));
    if (settings[setting::list_cap_order] == ListCapOrder::brightest) {
      const std::vector<uint32_t> expected = least(all, settings[setting::list_cap], by_dimness);
      right &= alike ? std::ranges::equal(kept, expected) : as_dim(kept, expected, by_dimness);
    }
    trials.wrong += !right;
  }
  return trials;
}

// Views one after the other in one run of each technique, in every order. Some list has to be shortened.
void capped(Check& c, Scene scene, const std::vector<View>& views, const std::vector<int>& caps,
            bool alike = false) {
  for (Light& light : scene.lights) light.casts_shadow = false;
  bool drawn = false;
  for (const auto& [technique, common] :
       {std::pair("visibility", "kernel-shape=lanes "), std::pair("visibility", "kernel-shape=group tile=8 "),
        std::pair("forward_plus", "tile=32 ")}) {
    const std::vector<GroupImage> whole =
        c.engine.group_images(scene, technique, views, settings_with(common));
    if (whole.empty()) continue;
    drawn = true;
    for (const int cap : caps) {
      for (const char* order : {"index", "distance", "brightest"}) {
        const std::string words = fmt::format("{}list-cap={} list-cap-order={}", common, cap, order);
        const Settings settings = settings_with(words);
        const std::vector<GroupImage> images = c.engine.group_images(scene, technique, views, settings);
        uint64_t shortened = 0;
        for (size_t i = 0; i < views.size(); ++i) {
          const CapTrials trials = compared(scene, views[i], whole[i], images[i], settings, alike);
          c.trials(trials.entries);
          c.contacts(trials.entries);
          shortened += trials.shortened;
          c.that(trials.wrong == 0, "{} {}, view {}: the lists of {} pixels are others", technique, words, i,
                 trials.wrong);
        }
        c.that(shortened > 0 || cap >= int(scene.lights.size()), "{} {}: no list is shortened", technique,
               words);
      }
    }
  }
  if (!drawn) c.skip("the engine only culls");
}

Scene capped_floor() {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 2, 2));
  add_triangles(scene, box_of({-1, 0, -1}, {-0.5f, 2, -0.5f}));
  return scene;
}
View of_capped(int width = 64, int height = 48) {
  return shadow_view({3, 2.5, 3.5}, {0, 0.3, 0}, width, height);
}

// All with one ball: their keys are equal, and the first are kept.
Scene alike_lamps(int lights) {
  Scene scene = capped_floor();
  for (int i = 0; i < lights; ++i) add_lamp(scene, {0.5, 0.5, 0.5}, 8);
  return scene;
}
void lights_alike(Check& c) { capped(c, alike_lamps(40), {of_capped()}, {1, 2, 32}, true); }

void around_the_cap(Check& c) {
  for (const int lights : {1, 15, 16, 17, 33}) capped(c, alike_lamps(lights), {of_capped()}, {16}, true);
}

// From 10^-15 to 10^15 candela, and dark ones.
void of_every_brightness(Check& c) {
  Random random(20261127);
  Scene scene = capped_floor();
  for (int i = 0; i < 61; ++i) {
    const dvec3 at = in_cube(random, 2.5);
    add_lamp(scene, {at.x, 0.4, at.z}, 12).intensity = i % 6 == 5 ? 0 : std::pow(10.0f, float(i % 31 - 15));
  }
  capped(c, scene, {of_capped()}, {1, 8, 32});
}

// At the eye, behind it, on surfaces, and so far away that squares overflow.
void of_every_distance(Check& c) {
  Scene scene = capped_floor();
  const View view = of_capped();
  const dvec3 ahead = -glm::transpose(glm::dmat3(view.view_from_world))[2];
  const float endless = std::numeric_limits<float>::infinity();
  for (const double at : {0.0, 1e-6, -1e-6, 0.01, -2.0, 3.0, 4.3, 1e3, -1e6, 1e12, -1e16})
    add_lamp(scene, view.eye + ahead * at, endless);
  for (const double x : {-1.0, 0.0, 1.5}) add_lamp(scene, {x, 0, 1}, endless);
  capped(c, scene, {view}, {1, 4, 8});
}

// Three of each brightness and place, the brightest last: of the dimmest that are kept, one or two.
void triples_at_the_cap(Check& c) {
  Scene scene = capped_floor();
  for (int i = 0; i < 48; ++i)
    add_lamp(scene, {0.1 * (i / 3) - 1, 0.5, 0.5}, 10).intensity = std::pow(16.0f, float(i / 3));
  capped(c, scene, {of_capped()}, {1, 2, 4, 8, 16, 32}, true);
}

// Lights that most tiles do not see, so that those they see have indices past 16 bits.
void indices_past_16_bits(Check& c) {
  Scene scene = capped_floor();
  for (int i = 0; i < 66'000; ++i) add_lamp(scene, {0, -500.0 - i, 0}, 0.1f);
  for (int i = 0; i < 60; ++i)
    add_lamp(scene, {0.05 * i - 1.5, 0.3, 0.02 * i}, 6).intensity = float(1 + i % 7);
  capped(c, scene, {of_capped()}, {8});
}

// One view after the other: ranks, tiles and intervals of the view before.
void cut_and_turned_views(Check& c) {
  Random random(7);
  Scene scene = capped_floor();
  for (int i = 0; i < 50; ++i) {
    const dvec3 at = in_cube(random, 3);
    add_lamp(scene, {at.x, 0.2 + 0.02 * i, at.z}, 9).intensity = random.uniform(0.1f, 8);
  }
  std::vector<View> views;
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {17, 9}, {1, 33}, {33, 1}, {65, 63}, {31, 47}, {16, 16}})
    views.push_back(of_capped(size.x, size.y));
  views.push_back(shadow_view({3, 2.5, 3.5}, {9, 9, 9}, 33, 17));  // a view of nothing
  views.push_back(shadow_view({-3, 1.5, 2}, {0, 0.3, 0}, 33, 17));
  views.push_back(shadow_view({0, 6, 0.1}, {0, 0, 0}, 33, 17, 0.5));
  Camera camera = look_at({3, 2.5, 3.5}, {0, 0.3, 0});
  camera.orthographic = true;
  camera.half_height_m = 2;
  camera.near_m = -20;
  camera.far_m = 30;
  views.push_back(make_view(camera, 47, 35));
  capped(c, scene, views, {4});
}

}  // namespace

std::vector<CaseRun> cap_cases() {
  return CASES(lights_alike, around_the_cap, of_every_brightness, of_every_distance, triples_at_the_cap,
               indices_past_16_bits, cut_and_turned_views);
}

}  // namespace lightgrid::lab::verify
