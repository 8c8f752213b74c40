// Hard cases of light groups: masks, instances and pixels for which a light is easily seen where it should
// not be, or lost. What a pixel must show is known without groups: the picture of the lights alone that share
// one with its surface.
#include <algorithm>
#include <set>

#include "oracle/lit_set.h"
#include "scene/light_groups.h"
#include "scene/view_lights.h"
#include "verify/check.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;

struct Way {
  const char *technique, *settings;  // assignments, with spaces between
  bool tiles = false;                // lists no light that no surface of the tile can have
  double most = 0;  // difference, of the brightest value: where groups change the sums' order
};

constexpr double rounding = 1e-6;

const std::vector<Way>& every_way() {
  static const std::vector<Way> ways = {
      {"forward", ""},
      {"forward_multipass", ""},
      {"forward_zprepass", "", false, rounding},
      {"forward_plus", "", true},
      {"forward_plus", "tile=8 kernel-shape=group group-ids=16", true},
      {"clustered", "depth-bounds=halfz", true},
      {"world_grid", ""},
      {"deferred", ""},
      {"deferred", "group-stencil=8", false, rounding},
      {"deferred", "group-stencil=6 volume-culling=stencil", false, rounding},
      {"deferred_tiled", "", true},
      {"deferred_tiled", "raster=opencl group-ids=16 kernel-shape=group", true},
      {"light_prepass", "", true},
      {"light_prepass", "raster=opencl", true},
      {"light_prepass", "prepass-lights=volumes", false, rounding},
      {"lidr", "lidr-overlap=16"},
      {"visibility", "", true},
      {"visibility", "kernel-shape=group tile=8", true},
  };
  return ways;
}

// The ways that draw several hundred masks.
const std::vector<Way>& numbered_ways() {
  static const std::vector<Way> ways = {
      {"forward_plus", "group-ids=16", true},
      {"deferred", "group-ids=16"},
      {"deferred_tiled", "group-ids=16", true},
      {"deferred_tiled", "raster=opencl group-ids=16", true},
      {"light_prepass", "group-ids=16", true},
      {"visibility", "", true},
      {"visibility", "kernel-shape=group tile=8", true},
  };
  return ways;
}

// Nobody has groups, and the lights are dark that share none with `groups`.
Scene alone(Scene scene, uint32_t groups) {
  for (Light& light : scene.lights) {
    if (!groups_meet(groups_of(light), groups)) light.intensity = 0;
    set_groups(light, all_groups);
  }
  for (Instance& instance : scene.instances) set_groups(instance, all_groups);
  return scene;
}

// Entries of lists whose light no surface of the tile can have.
uint64_t entries_outside(const Scene& scene, const View& view, const GroupImage& image) {
  const size_t across = size_t(view.width + image.tile - 1) / size_t(image.tile);
  const auto tile_of = [&](size_t pixel) {
    return pixel / size_t(view.width) / size_t(image.tile) * across +
           pixel % size_t(view.width) / size_t(image.tile);
  };
  std::vector<uint32_t> of_tiles(across * size_t(view.height));
  for (size_t i = 0; i < image.groups.size(); ++i) of_tiles[tile_of(i)] |= image.groups[i];
  uint64_t outside = 0;
  for (size_t i = 0; i < image.groups.size(); ++i) {
    if (!(image.depths[i] > 0)) continue;
    const size_t cell = image.lists.cell_of_pixel[i];
    for (uint32_t k = 0; k < image.lists.count[cell]; ++k) {
      const int light = image.lights[image.lists.indices[image.lists.first[cell] + k]];
      outside += !groups_meet(groups_of(scene.lights[size_t(light)]), of_tiles[tile_of(i)]);
    }
  }
  return outside;
}

// The largest difference at pixels of a mask, of the brightest value.
double difference(const GroupImage& image, const GroupImage& expected, uint32_t mask) {
  double brightest = 0, most = 0;
  for (const glm::vec4& p : expected.pixels)
    brightest = std::max({brightest, double(p.r), double(p.g), double(p.b)});
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    if (image.groups[i] != mask || !(image.depths[i] > 0)) continue;
    for (int c = 0; c < 3; ++c) {
      const double apart = std::abs(double(image.pixels[i][c]) - double(expected.pixels[i][c]));
      most = std::max(most, apart >= 0 ? apart : std::numeric_limits<double>::infinity());
    }
  }
  return brightest > 0 ? most / brightest : most;
}

// In each way: no lit pair is lost, no light is listed where no surface has its groups, and at the pixels of
// each mask the picture is that of the lights alone which share a group with it.
void groups_shown(Check& c, Scene scene, const std::vector<View>& views,
                  const std::vector<Way>& ways = every_way(), size_t max_masks = 4) {
  for (Light& light : scene.lights) light.casts_shadow = false;
  std::set<uint32_t> masks;
  for (const Instance& instance : scene.instances) masks.insert(groups_of(instance));
  while (masks.size() > max_masks) masks.erase(std::next(masks.begin(), long(masks.size() / 2)));
  bool drawn = false;
  for (const Way& way : ways) {
    const Settings settings = settings_with(way.settings);
    const std::vector<GroupImage> images = c.engine.group_images(scene, way.technique, views, settings);
    if (images.empty()) continue;
    drawn = true;
    for (size_t i = 0; i < images.size(); ++i) {
      const GroupImage& image = images[i];
      std::vector<ViewLight> lights;
      const std::vector<ViewLight> all = lights_in_view(scene, views[i]);
      for (const int light : image.lights) lights.push_back(all[size_t(light)]);
      const LitPairs pairs = count_pairs(views[i], image.depths, lights, image.lists, nullptr, image.groups);
      c.trials(pairs.listed + pairs.lit);
      c.contacts(pairs.lit);
      if (pairs.lost > 0)
        c.lost_pairs(pairs.lost, "{} {}, view {}: {} of {} pairs are not listed", way.technique, way.settings,
                     i, pairs.lost, pairs.lit);
      const uint64_t outside = way.tiles ? entries_outside(scene, views[i], image) : 0;
      c.that(pairs.wrong == 0 && outside == 0,
             "{} {}, view {}: {} entries are no light or listed twice, {} are of groups that no surface has",
             way.technique, way.settings, i, pairs.wrong, outside);
    }
    for (const uint32_t mask : masks) {
      const auto expected = c.engine.group_images(alone(scene, mask), way.technique, views, settings);
      for (size_t i = 0; i < images.size(); ++i) {
        const double apart = difference(images[i], expected[i], mask);
        c.that(apart <= way.most, "{} {}, view {}: surfaces with the groups {:x} differ by {:.2g}",
               way.technique, way.settings, i, mask, apart);
      }
    }
  }
  if (!drawn) c.skip("the engine draws no pictures");
}

constexpr uint32_t last = 1u << 31;

View of_strips(int width = 61, int height = 43) {
  return shadow_view({0, 0.2, 3.2}, {0, 0, 0}, width, height);
}

// Upright strips side by side before a wall, each with its mask.
Scene strips(const std::vector<uint32_t>& masks, float across = 4) {
  Scene scene = empty_shadow_scene();
  const float each = across / float(masks.size());
  for (size_t i = 0; i < masks.size(); ++i) {
    const float x = -0.5f * across + each * float(i);
    set_groups(add_triangles(scene, quad_of({x, -1.2f, 0.2f * float(i % 3)}, {each, 0, 0}, {0, 2.4f, 0})),
               masks[i]);
  }
  set_groups(add_triangles(scene, quad_of({-3, -2, -1}, {6, 0, 0}, {0, 4, 0})), masks.front());
  return scene;
}

Light& add_grouped(Scene& scene, const dvec3& position, uint32_t groups, float radius_m = 2.5f) {
  Light& light = add_lamp(scene, position, radius_m);
  set_groups(light, groups);
  return light;
}

void add_sun(Scene& scene, const glm::vec3& direction, uint32_t groups) {
  Light sun;
  sun.name = "sun";
  sun.type = LightType::directional;
  set_groups(sun, groups);
  sun.direction = glm::normalize(direction);
  sun.intensity = 0.4f;
  scene.lights.push_back(sun);
}

// The sign bit, and its neighbours: masks as signed integers, or shifted by one too many.
void first_and_last_group(Check& c) {
  Scene scene = strips({1, last, last >> 1, ~last, 1 | last, all_groups, 2});
  const uint32_t masks[] = {1, last, last >> 1, ~last, ~1u, all_groups, 2 | last};
  for (int i = 0; i < 7; ++i) add_grouped(scene, {-1.8 + 0.6 * i, 0.3 * (i % 2), 0.9}, masks[i]);
  add_sun(scene, {0.3f, -0.6f, -1}, last);
  groups_shown(c, scene, {of_strips()});
}

// Surfaces that nothing lights, and lights that light nothing.
void no_group(Check& c) {
  Scene scene = strips({0, 1, all_groups, 0, 2});
  for (int i = 0; i < 8; ++i)
    add_grouped(scene, {-1.7 + 0.5 * i, 0.2, 0.8},
                i % 4 == 0   ? 0
                : i % 4 == 1 ? all_groups
                             : uint32_t(i % 4 - 1));
  groups_shown(c, scene, {of_strips()});
}

// Lights of a group that nobody has change no picture, no lit pair and no list of a tile.
void masked_lights_change_nothing(Check& c) {
  Scene scene = strips({1, 2, 3, 1 | last});
  for (int i = 0; i < 6; ++i) add_grouped(scene, {-1.5 + 0.6 * i, 0.1, 0.9}, i % 2 ? 1 : 2 | last);
  Scene more = scene;
  Random random(20261126);
  for (int i = 0; i < 40; ++i) add_grouped(more, in_cube(random, 1.5), 1u << 12 | 1u << (13 + i % 18));
  for (Scene* of : {&scene, &more})
    for (Light& light : of->lights) light.casts_shadow = false;
  const std::vector<View> views = {of_strips()};
  for (const Way& way : every_way()) {
    if (std::string_view(way.technique) == "lidr") continue;  // which lists what volumes cover: 16 at most
    const auto images = c.engine.group_images(scene, way.technique, views, settings_with(way.settings));
    const auto with_more = c.engine.group_images(more, way.technique, views, settings_with(way.settings));
    if (images.empty() || with_more.empty()) continue;
    for (const uint32_t mask : {1u, 2u, 3u, 1 | last}) {
      const double apart = difference(with_more[0], images[0], mask);
      c.that(apart <= way.most, "{} {}: lights of no surface's groups change groups {:x} by {:.2g}",
             way.technique, way.settings, mask, apart);
    }
    const uint64_t outside = way.tiles ? entries_outside(more, views[0], with_more[0]) : 0;
    c.that(outside == 0, "{} {}: {} entries are of groups that no surface has", way.technique, way.settings,
           outside);
  }
  groups_shown(c, more, views);
}

// Surfaces of a pixel in the corners of tiles, whose groups nothing else in the tile has.
void single_pixels(Check& c) {
  for (const glm::ivec2 size : {glm::ivec2(61, 43), {16, 16}, {33, 17}, {1, 1}}) {
    const View view = of_strips(size.x, size.y);
    Scene scene = empty_shadow_scene();
    set_groups(add_triangles(scene, quad_of({-6, -4, 0}, {12, 0, 0}, {0, 8, 0})), 1);
    const dvec3 right = glm::transpose(glm::dmat3(view.view_from_world))[0],
                up = glm::transpose(glm::dmat3(view.view_from_world))[1],
                ahead = -glm::transpose(glm::dmat3(view.view_from_world))[2];
    int count = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const bool corner = (x % 16 == 0 || x % 16 == 15 || x == size.x - 1) &&
                            (y % 16 == 0 || y % 16 == 15 || y == size.y - 1);
        if (!corner) continue;
        const double slope_x = ((x + 0.5) * 2 / size.x - 1) / view.clip_from_view[0][0],
                     slope_y = ((y + 0.5) * 2 / size.y - 1) / view.clip_from_view[1][1];
        const double half = 0.4 / (view.clip_from_view[1][1] * size.y);
        const dvec3 at = view.eye + 2.5 * (ahead + slope_x * right + slope_y * up);
        ShadowTriangles quad = quad_of(glm::vec3(at - 2.5 * half * (right + up)), glm::vec3(5 * half * right),
                                       glm::vec3(5 * half * up));
        set_groups(add_triangles(scene, quad), 1u << (1 + count++ % 31));
      }
    }
    for (int i = 0; i < 32; ++i) add_grouped(scene, {-1.5 + 0.1 * i, 0.4 * (i % 3) - 0.4, 1.2}, 1u << i, 6);
    groups_shown(c, scene, {view}, numbered_ways());
  }
}

// Numbers of a byte, one more, and more than suffice.
void around_256_masks(Check& c) {
  for (const uint32_t count : {255u, 256u, 257u, 300u}) {
    std::vector<uint32_t> masks;
    for (uint32_t i = 0; i < count; ++i) masks.push_back(1 + i * 3);
    Scene scene = strips(masks);
    set_groups(scene.instances.back(), masks.front());
    for (int i = 0; i < 10; ++i) add_grouped(scene, {-1.8 + 0.4 * i, 0, 0.9}, 1u << i);
    groups_shown(c, scene, {of_strips(241, 43)}, numbered_ways(), 6);
    if (count > 256) continue;
    static const std::vector<Way> bytes = {
        {"deferred", ""}, {"deferred_tiled", "", true}, {"deferred_tiled", "raster=opencl", true}};
    groups_shown(c, scene, {of_strips(241, 43)}, bytes, 6);
  }
}

// Surfaces at one depth with different masks: the groups are those of the surface that is shown.
void at_one_depth(Check& c) {
  Scene scene = empty_shadow_scene();
  for (const uint32_t mask : {1u, 2u, 4u}) {
    set_groups(add_triangles(scene, quad_of({-2, -1, 0}, {4, 0, 0}, {0, 2, 0})), mask);
    set_groups(add_triangles(scene, quad_of({-1, -0.5f, 0}, {1, 0, 0}, {0, 1, 0})), mask << 3);
  }
  for (int i = 0; i < 6; ++i) add_grouped(scene, {-1.5 + 0.6 * i, 0, 0.7}, 1u << i, 3);
  groups_shown(c, scene, {of_strips(), shadow_view({0.5, 0.4, -3}, {0, 0, 0}, 61, 43)});
}

// Sky has no groups, also beside surfaces and after a view that is full of them.
void sky_has_none(Check& c) {
  Scene scene = empty_shadow_scene();
  set_groups(add_triangles(scene, quad_of({40, -1, 0}, {1, 0, 0}, {0, 2, 0})), 1);  // number 0, out of view
  for (int i = 0; i < 5; ++i)
    set_groups(add_triangles(
                   scene, box_of({-1.8f + 0.8f * float(i), -0.2f, 0}, {-1.7f + 0.8f * float(i), 0.1f, 0.1f})),
               2u << i);
  for (int i = 0; i < 12; ++i) add_grouped(scene, {-1.8 + 0.33 * i, 0, 0.5}, 1u << i % 6, 1.5f);
  groups_shown(c, scene,
               {of_strips(), shadow_view({0, 0.2, 0.6}, {0, 0, 0}, 61, 43),
                shadow_view({0, 0.2, 3.2}, {0, 9, 9}, 61, 43), of_strips()});
}

// Masks of directional lights lie behind those of the others, and those of instances behind both.
void directional_lights(Check& c) {
  for (const auto& [lamps, suns] : {std::pair(0, 1), {0, 3}, {1, 2}, {5, 4}}) {
    Scene scene = strips({1, 2, 4, 6, 0, last});
    for (int i = 0; i < suns; ++i) {
      add_sun(scene, {0.4f * float(i) - 0.5f, -0.5f, -1}, i == 3 ? last | 2 : 1u << i);
      if (i < lamps) add_grouped(scene, {-1.2 + 0.8 * i, 0, 0.8}, 4u >> i % 3);
    }
    groups_shown(c, scene, {of_strips()});
  }
}

// Masks belong to instances, however these are placed.
void mirrored_and_sheared_groups(Check& c) {
  Scene scene = strips({1, 2, 4, 8});
  for (int i = 0; i < 4; ++i) {
    glm::dmat4 placed(1);
    placed[3] = {-1.5 + i, -0.3 + 0.2 * i, 0.6, 1};
    placed[0] = {i % 2 ? -0.4 : 0.4, 0.2, 0, 0};
    placed[2][2] = i < 2 ? 1e-3 : 1;
    set_groups(add_triangles(scene, box_of({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), placed), 16u << i % 2);
  }
  for (int i = 0; i < 6; ++i) add_grouped(scene, {-1.6 + 0.45 * i, 0.3, 1.4}, 1u << i, 4);
  groups_shown(c, scene, {of_strips()});
}

// The strips stand at z = 0, 0.2 and 0.4.
void ranges_that_end_on_strips(Check& c) {
  Scene scene = strips({1, 2, 4, 1, 2, 4});
  for (int i = 0; i < 9; ++i)
    add_grouped(scene, {-1.6 + 0.4 * i, 0.1, 0.9}, 1u << i % 3,
                std::nextafter(0.5f + 0.2f * float(i % 3), 1.0f));
  groups_shown(c, scene, {of_strips()});
}

void lamps_inside_surfaces(Check& c) {
  Scene scene = strips({1, 2, 4, 8});
  set_groups(add_triangles(scene, box_of({-0.3f, -0.3f, 0.7f}, {0.3f, 0.3f, 1.3f})), 16);
  for (const uint32_t mask : {16u, 1u}) add_grouped(scene, {0, 0, 1}, mask);
  for (int i = 0; i < 8; ++i) add_grouped(scene, {-1.7 + 0.45 * i, 0.1, 0.2 * (i % 3)}, 1u << i % 4);
  groups_shown(c, scene, {of_strips()});
}

// Scenes of a seed each: masks, strips, boxes, lamps, spots and suns at random.
void random_masks(Check& c) {
  const uint64_t scenes = c.adversarial_lights > 1'000'000 ? 400 : c.adversarial_lights > 0 ? 12 : 4;
  for (uint64_t seed = 1; seed <= scenes; ++seed) {
    Random random(seed * 7919);
    const auto mask = [&] {
      const uint64_t kind = random.next() % 6;
      const uint32_t bits = uint32_t(random.next());
      return kind == 0   ? 0u
             : kind == 1 ? all_groups
             : kind == 2 ? bits
                         : 1u << bits % 32 | 1u << (bits >> 8) % 4;
    };
    std::vector<uint32_t> masks;
    for (uint64_t i = 2 + random.next() % 7; i > 0; --i) masks.push_back(mask());
    Scene scene = strips(masks);
    for (uint64_t i = random.next() % 6; i > 0; --i) {
      const dvec3 at = in_cube(random, 1.2);
      const uint32_t own = mask();
      set_groups(add_triangles(scene, box_of(glm::vec3(at), glm::vec3(at) + random.uniform(0.05f, 0.6f))),
                 own);
    }
    for (uint64_t i = 1 + random.next() % 12; i > 0; --i)
      add_grouped(scene, in_cube(random, 1.5), mask(), random.uniform(0.3f, 4));
    for (uint64_t i = random.next() % 3; i > 0; --i) {
      const uint32_t own = mask();
      set_groups(add_spot_lamp(scene, in_cube(random, 2), in_cube(random, 0.5), random.uniform(0.1f, 1.4f)),
                 own);
    }
    for (uint64_t i = random.next() % 3; i > 0; --i)
      add_sun(scene, {random.uniform(-1, 1), -0.7f, random.uniform(-1, 0)}, mask());
    std::vector<Way> ways = {every_way()[seed % every_way().size()], {"visibility", "", true}};
    if (std::string_view(ways[0].settings).find("stencil") != std::string_view::npos)
      ways.erase(ways.begin());
    groups_shown(c, scene, {of_strips(), shadow_view(in_cube(random, 2.5), {0, 0, 0}, 47, 35)}, ways);
  }
}

}  // namespace

std::vector<CaseRun> group_cases() {
  return CASES(first_and_last_group, no_group, masked_lights_change_nothing, single_pixels, around_256_masks,
               at_one_depth, sky_has_none, directional_lights, mirrored_and_sheared_groups,
               ranges_that_end_on_strips, lamps_inside_surfaces, random_masks);
}

}  // namespace lightgrid::lab::verify
