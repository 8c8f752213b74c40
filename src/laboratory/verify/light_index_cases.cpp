// Hard cases of light indices: lights, cameras and images for which an index is easily lost, or becomes
// another.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/ranges.h>

#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "passes/light_index/lidr_settings.h"
#include "plan/settings/surfaces.h"
#include "scene/view_lights.h"
#include "verify/hunt_cases.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;

constexpr int no_limit = 1 << 20;

struct Listing {
  std::string settings;  // assignments, split at spaces
  int room = no_limit;   // lights that a pixel holds: further ones are lost
};

// Returns whether a light may be listed for a surface at p: its volume exceeds its range by so much at most,
// and half a pixel for how corners are drawn. Behind front faces, the sight to p passes through it.
bool may_be_listed(const View& view, const ViewLight& light, const dvec3& p, bool behind, bool box) {
  const bool cone = light.type == LightType::spot && light.cos_outer > 0;
  // A cone is grown by moving it back, by 1 / sin of its angle.
  const double moved = cone ? 1 + 1 / std::sqrt(1 - light.cos_outer * light.cos_outer) : 1;
  const double factor = cone ? 1.8 * (1 + moved / 64) : box ? 1.8 : 1.35;
  const double half_pixel = glm::length(p) / (view.clip_from_view[1][1] * std::min(view.width, view.height));
  const double along = behind ? std::clamp(glm::dot(light.position, p) / glm::dot(p, p), 0.0, 1.0) : 1;
  return glm::length(along * p - light.position) <= factor * light.radius_m + (box ? 2 : moved) * half_pixel;
}

// Compares each pixel's list with the oracle: every light that lights it is there, as far as there is room,
// no light occurs twice, and each may reach it.
void light_indices(Check& c, Scene scene, const std::vector<View>& views,
                   const std::vector<Listing>& listings) {
  for (Light& light : scene.lights) light.casts_shadow = false;
  for (const Listing& listing : listings) {
    const Settings settings = settings_with(listing.settings);
    const bool box = settings[setting::volume_mesh] == VolumeMeshes::box;
    const bool behind = settings[setting::lidr_volumes] == LidrVolumes::front_faces;
    const bool anywhere =
        settings[setting::lidr_volumes] == LidrVolumes::no_prepass;  // along the sight, or past it
    const std::vector<ListImage> images = c.engine.lists(scene, "lidr", views, settings);
    if (images.empty()) return c.skip("the engine draws no light volumes");
    for (size_t i = 0; i < views.size(); ++i) {
      const View& view = views[i];
      const std::vector<ViewLight> lights = lights_in_view(scene, view);
      const std::vector<float>& depths = images[i].depths;
      const ListedLights& lists = images[i].lists;
      const LitPairs pairs = count_pairs(view, depths, lights, lists);
      uint64_t past = 0, out_of_reach = 0;
      for (size_t pixel = 0; pixel < depths.size(); ++pixel) {
        if (!(depths[pixel] > 0)) continue;
        past += uint64_t(std::max(0, int(pairs.lit_of_pixel[pixel]) - listing.room));
        const dvec3 p =
            lab::position_from_depth(view, int(pixel) % view.width, int(pixel) / view.width, depths[pixel]);
        const size_t cell = lists.cell_of_pixel[pixel];
        for (uint32_t k = 0; k < lists.count[cell]; ++k) {
          const uint32_t light = lists.indices[lists.first[cell] + k];
          out_of_reach +=
              light < lights.size() && !anywhere && !may_be_listed(view, lights[light], p, behind, box);
        }
      }
      c.trials(pairs.listed + pairs.lit);
      c.contacts(pairs.lit);
      if (pairs.lost > past)
        c.lost_pairs(pairs.lost - past, "{}, view {}: {} of {} pairs are not listed", listing.settings, i,
                     pairs.lost - past, pairs.lit);
      c.that(pairs.wrong == 0 && out_of_reach == 0,
             "{}, view {}: {} entries are no light or listed twice, {} lights are far from their pixel",
             listing.settings, i, pairs.wrong, out_of_reach);
      c.that(listing.room == no_limit || past > 0, "{}, view {}: nothing is past the limit", listing.settings,
             i);
    }
  }
}

Scene floor_scene() {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 2, 2));
  add_triangles(scene, box_of({-1, 0, -1}, {-0.5f, 2, -0.5f}));
  return scene;
}
View of_floor(int width = 64, int height = 48) {
  return shadow_view({3, 2.5, 3.5}, {0, 0.3, 0}, width, height);
}
View from_above(int width = 64, int height = 48) {
  return shadow_view({0, 6, 0.1}, {0, 0, 0}, width, height);
}

// Lights in clusters of `overlap`, which neither touch nor cover each other from above.
Scene clusters(int overlap, int lights) {
  Scene scene = floor_scene();
  const int across = int(std::ceil(std::sqrt(lights / overlap + 1)));
  const double apart = 6.0 / across;
  for (int i = 0; i < lights; ++i) {
    const int cluster = i / overlap;
    const dvec3 at(-3 + apart * (cluster % across), 0.02 * apart, -3 + apart * (cluster / across));
    add_lamp(scene, at + dvec3(1e-3 * apart * (i % overlap), 0, 0), float(0.3 * apart));
  }
  return scene;
}

// Index 0 means none, so that light i has index i + 1: the first light, the last one of each size of an
// index, and those beside it.
void first_and_last_index(Check& c) {
  for (const int lights : {1, 14, 15, 16, 254, 255, 256, 257, 4099}) {
    light_indices(c, clusters(4, lights), {from_above(160, 160)},
                  {{"lidr-overlap=4"},
                   {"lidr-overlap=4 lidr-packing=maxblend"},
                   {"lidr-overlap=4 lidr-packing=sort"},
                   {"lidr-overlap=4 lidr-packing=maxblend-sort"},
                   {"lidr-overlap=4 lidr-volumes=front-faces"}});
  }
}

// As many lights as there is room for, all with the same ball.
Scene coincident(int lights) {
  Scene scene = floor_scene();
  for (int i = 0; i < lights; ++i) add_lamp(scene, {0.5, 0.5, 0.5}, 2.5f);
  return scene;
}
void full_pixels(Check& c) {
  for (const int room : {1, 2, 4, 8, 16}) {
    const std::string overlap = fmt::format("lidr-overlap={}", room);
    const std::string sorted = overlap + " lidr-packing=sort", both = overlap + " lidr-packing=maxblend-sort",
                      faces = overlap + " lidr-volumes=front-faces";
    light_indices(c, coincident(room), {of_floor()}, {{overlap}, {sorted}, {both}, {faces}});
  }
}

// More lights than a pixel has room for: some are lost, and none becomes another.
void past_the_limit(Check& c) {
  for (const int room : {1, 2, 4, 8}) {
    const std::string overlap = fmt::format("lidr-overlap={}", room);
    const std::string sorted = overlap + " lidr-packing=sort", both = overlap + " lidr-packing=maxblend-sort",
                      faces = overlap + " lidr-volumes=front-faces";
    light_indices(c, coincident(room + 3), {of_floor()},
                  {{overlap, room}, {sorted, room}, {both, room}, {faces, room}});
  }
}

// The eye in volumes, on their surfaces, and so close that the near plane cuts them.
void eye_in_volumes(Check& c) {
  Scene scene = floor_scene();
  const View view = of_floor();
  const dvec3 ahead = -glm::transpose(glm::dmat3(view.view_from_world))[2];
  for (const double reach : {6.0, 5.0}) {
    for (const double at : {0.0, 0.01, -1.0, 2.0}) add_lamp(scene, view.eye + ahead * at, float(reach));
  }
  for (const double off : {-0.02, -1e-6, 0.0, 1e-6, 0.02})
    add_lamp(scene, view.eye + ahead * 4.0, float(4 + off));
  light_indices(c, scene, {view},
                {{""},
                 {"lidr-volumes=front-faces"},
                 {"volume-mesh=box"},
                 {"lidr-packing=sort"},
                 {"lidr-packing=maxblend-sort"}});
}

// Lights that touch, almost touch, coincide and contain each other: groups need passes for all of them.
void groups_that_touch(Check& c) {
  Random random(20261126);
  Scene scene = floor_scene();
  for (int i = 0; i < 12; ++i) {
    for (const double gap : {-1e-9, 0.0, 1e-9}) add_lamp(scene, {-3 + 0.5 * i * (1 + gap), 0.1, 0.3}, 0.25f);
  }
  for (int i = 0; i < 20; ++i) {
    const dvec3 at = in_cube(random, 2.5);
    add_lamp(scene, {at.x, 0.2, at.z}, random.uniform(0.1f, 1.5f));
  }
  light_indices(c, scene, {of_floor(), from_above()},
                {{"lidr-packing=sort lidr-overlap=4 lidr-passes=16"},
                 {"lidr-packing=maxblend-sort lidr-overlap=4 lidr-passes=16"},
                 {"lidr-packing=sort lidr-overlap=4 lidr-passes=16 lidr-sort=still"},
                 {"lidr-packing=maxblend-sort lidr-overlap=4 lidr-passes=16 lidr-sort=still"},
                 {"lidr-packing=sort lidr-overlap=4 lidr-passes=16 lidr-volumes=front-faces"}});
}

// A camera that moves from light to light: groups of still lights are found before most are seen.
void groups_of_still_lights(Check& c) {
  Random random(20261127);
  Scene scene = floor_scene();
  for (int i = 0; i < 60; ++i) {
    const dvec3 at = in_cube(random, 3.5);
    add_lamp(scene, {at.x, 0.1, at.z}, random.uniform(0.05f, 0.8f));
  }
  std::vector<View> views;
  for (int i = 0; i < 6; ++i)
    views.push_back(
        shadow_view({3 * std::cos(i * 1.1), 0.3 + 0.4 * i, 3 * std::sin(i * 1.1)}, {0.2 * i, 0, 0}));
  views.push_back(shadow_view({300, 200, 100}, {0, 0, 0}, 64, 48, 0.03));  // rounding grows volumes
  light_indices(c, scene, views,
                {{"lidr-packing=sort lidr-overlap=8 lidr-passes=8 lidr-sort=still"},
                 {"lidr-packing=maxblend-sort lidr-overlap=4 lidr-passes=16 lidr-sort=still"},
                 {"lidr-packing=sort lidr-overlap=8 lidr-passes=8"}});
}

// One view after the other: what an image of another size has left.
void cut_images(Check& c) {
  std::vector<View> views;
  for (const glm::ivec2 size : {glm::ivec2(1, 1), {17, 9}, {1, 33}, {33, 1}, {65, 63}, {31, 47}, {16, 16}})
    views.push_back(of_floor(size.x, size.y));
  views.push_back(shadow_view({3, 2.5, 3.5}, {9, 9, 9}, 33, 17));  // a view of nothing
  views.push_back(of_floor(33, 17));
  light_indices(c, coincident(8), views,
                {{"lidr-overlap=8"},
                 {"lidr-packing=sort lidr-overlap=8"},
                 {"lidr-packing=maxblend-sort lidr-overlap=4 lidr-passes=2"},
                 {"lidr-overlap=8 lidr-volumes=front-faces"},
                 {"lidr-overlap=8 lidr-volumes=no-prepass"}});
}

// Cones of 0.01 to pi rad, ranges of 1 mm to infinity, and cameras that see them from 0.3 m to 300 m away.
void cones_and_ranges(Check& c) {
  Scene scene = floor_scene();
  for (const double outer : {0.01, 0.3, 0.52, 0.53, 1.0, 1.5, 1.5707, 1.58, 3.0})
    add_spot_lamp(scene, {2 - 1.5 * outer, 1.2, 0.4}, {2 - 1.6 * outer, 0, 0.3}, outer, 1.6f);
  for (const float radius : {1e-3f, 0.05f, 3.0f, 1e4f, std::numeric_limits<float>::infinity()})
    add_lamp(scene, {0.6, 0.04, 0.9}, radius);
  light_indices(c, scene,
                {of_floor(), shadow_view({0.6, 0.3, 1.1}, {0.6, 0, 0.9}),
                 shadow_view({300, 250, 100}, {0, 0, 0}, 64, 48, 0.03)},
                {{""},
                 {"volume-mesh=box"},
                 {"volume-mesh=icosahedron"},
                 {"lidr-packing=sort"},
                 {"lidr-packing=maxblend-sort"}});
}

// Spots with equal angles, whose edge is a step, and of 90 degrees as floats have them.
void hard_edges(Check& c) {
  constexpr double right_angle = std::numbers::pi_v<float> / 2;
  Scene scene = floor_scene();
  for (const double outer : {0.01, 0.3, 1.0, right_angle, right_angle, 3.0}) {
    Light& light = add_spot_lamp(scene, {2 - 1.5 * outer, 1.2, 0.4}, {2 - 1.6 * outer, 0, 0.3}, outer, 1.6f);
    if (scene.lights.size() % 2 == 0 || outer < 1) light.inner_cone_rad = light.outer_cone_rad;
  }
  light_indices(c, scene, {of_floor(), from_above()},
                {{""}, {"volume-mesh=box"}, {"lidr-packing=sort"}, {"lidr-packing=maxblend-sort"}});
}

// A packing with its room, and as few lights as it certainly holds.
struct RandomPacking {
  std::string settings;
  int overlap = 1, room = 1;            // channels or slots of a pass; of all passes
  bool sorted = false, inside = false;  // lists surfaces inside volumes alone
};
RandomPacking random_packing(Random& random, bool passes) {
  const auto one_of = [&](auto... values) {
    const std::common_type_t<decltype(values)...> all[] = {values...};
    return all[random.next() % sizeof...(values)];
  };
  RandomPacking packing;
  const std::string name = one_of("bitshift", "maxblend", "sort", "maxblend-sort");
  packing.sorted = name.ends_with("sort");
  packing.overlap = name == "maxblend" ? one_of(1, 2, 4) : one_of(1, 2, 4, 8);
  packing.room = packing.overlap;
  const std::string volumes = one_of("stencil", "stencil", "front-faces", "no-prepass");
  packing.inside = volumes == "stencil";
  packing.settings =
      fmt::format("lidr-packing={} lidr-overlap={} lidr-volumes={} lidr-unpack={} volume-mesh={}", name,
                  packing.overlap, volumes, one_of("integer", "float"), one_of("auto", "icosahedron", "box"));
  if (packing.sorted && passes) {
    const int count = one_of(1, 2, 4);
    packing.room *= count;
    const bool still = packing.inside && random.next() % 2;  // else groups depend on the view
    packing.settings += fmt::format(" lidr-passes={} lidr-sort={}", count, still ? "still" : "view");
  }
  return packing;
}

View random_view_of_floor(Random& random) {
  const double angle = random.uniform(0, 6.28f), away = random.uniform(0.5f, 6), up = random.uniform(0.1f, 5);
  const dvec3 target = in_cube(random, 1);
  const double fov = random.uniform(0.2f, 1.8f);
  return shadow_view({away * std::cos(angle), up, away * std::sin(angle)}, {target.x, 0.2, target.z},
                     1 + int(random.next() % 100), 1 + int(random.next() % 80), fov);
}

void add_random_light(Scene& scene, Random& random) {
  dvec3 at = in_cube(random, 3);
  at.y = std::abs(at.y) - 0.1;
  if (!scene.lights.empty() && random.next() % 8 == 0)
    at = scene.lights[random.next() % scene.lights.size()].position;
  const float radius =
      random.next() % 16 == 0 ? std::numeric_limits<float>::infinity() : std::exp2(random.uniform(-8, 4));
  if (random.next() % 3 == 0)
    add_spot_lamp(scene, at, at + any_direction(random), random.uniform(0.02f, 3.1f), radius);
  else
    add_lamp(scene, at, radius);
}

// Lights that reach no surface, before and between the others, so that these have any index.
void add_far_lights(Scene& scene, Random& random) {
  constexpr size_t totals[] = {1, 14, 15, 16, 254, 255, 256, 257, 300, 4099};
  const size_t total = totals[random.next() % std::size(totals)];
  while (scene.lights.size() < total) {
    Scene far;
    Light light = add_lamp(far, {in_cube(random, 9).x, 1000, in_cube(random, 9).z}, 1e-3f);
    scene.lights.insert(scene.lights.begin() + std::ptrdiff_t(random.next() % (scene.lights.size() + 1)),
                        light);
  }
}

// Unpacking gives what was packed: no more lights than there is room for, in any packing; each is listed
// where it lights, and nothing else is.
void packings(Check& c, Random& random) {
  const RandomPacking packing = random_packing(random, true);
  Scene scene = floor_scene();
  const uint64_t lights = 1 + random.next() % uint64_t(packing.room);
  for (uint64_t i = 0; i < lights; ++i) add_random_light(scene, random);
  // Behind front faces in view everything is listed, and groups of still lights are of all.
  if (packing.inside) add_far_lights(scene, random);
  const View first = random_view_of_floor(random), second = random_view_of_floor(random);
  light_indices(c, scene, {first, second, first}, {{packing.settings}});
}

// More lights than there is room for, which all reach all surfaces: a pixel has those of most influence.
void priority(Check& c, Random& random) {
  const RandomPacking packing = random_packing(random, false);
  Scene scene = floor_scene();
  const uint64_t more = 1 + random.next() % 20;
  for (uint64_t i = 0; i < uint64_t(packing.overlap) + more; ++i) {
    const dvec3 at = in_cube(random, 3);
    const float radius = random.uniform(20, 200);
    Light& light = add_lamp(scene, {at.x, std::abs(at.y), at.z}, radius);
    light.casts_shadow = false;
    light.intensity = std::exp2(random.uniform(-3, 3));
  }
  const View view = random_view_of_floor(random);
  const Settings settings = settings_with(packing.settings);
  const std::vector<ListImage> images = c.engine.lists(scene, "lidr", {&view, 1}, settings);
  if (images.empty()) return c.skip("the engine draws no light volumes");
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  std::vector<uint32_t> expected(lights.size());
  std::iota(expected.begin(), expected.end(), 0u);
  std::ranges::sort(expected, std::greater(), [&](uint32_t i) { return influence_of(lights[i]); });
  expected.resize(size_t(packing.overlap));
  std::ranges::sort(expected);
  const ListedLights& lists = images[0].lists;
  for (size_t pixel = 0; pixel < images[0].depths.size(); ++pixel) {
    if (!(images[0].depths[pixel] > 0)) continue;
    const size_t cell = lists.cell_of_pixel[pixel];
    const auto from = lists.indices.begin() + std::ptrdiff_t(lists.first[cell]);
    std::vector<uint32_t> listed(from, from + lists.count[cell]);
    std::ranges::sort(listed);
    c.contacts(expected.size());
    if (!c.that(listed == expected, "{}: pixel {} lists {}, not {}", packing.settings, pixel,
                fmt::join(listed, " "), fmt::join(expected, " ")))
      return;
  }
}

}  // namespace

std::vector<RandomCase> random_light_index_cases() {
  return {{"packings", packings}, {"priority", priority}};
}

std::vector<CaseRun> light_index_cases() {
  return CASES(first_and_last_index, full_pixels, past_the_limit, eye_in_volumes, groups_that_touch,
               groups_of_still_lights, cut_images, cones_and_ranges, hard_edges);
}

}  // namespace lightgrid::lab::verify
