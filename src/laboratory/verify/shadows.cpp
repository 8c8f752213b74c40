// Hard cases of exact shadows: lights, triangles and instances on which a ray's answer is easily wrong.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/compose.h"
#include "verify/shadow_check.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

// Lamps down to a hair above a wide floor of two triangles. Also where its normal is rounded.
void grazing(Check& c) {
  Scene scene = furnished_floor(1);
  for (int i = 0; i < 28; ++i) {
    const double angle = i * std::numbers::pi / 14, height = std::exp2(-0.5 * i);
    add_lamp(scene, {3.5 * std::cos(angle), height, 3.5 * std::sin(angle)});
  }
  std::vector<View> views = {of_the_floor(96, 64), shadow_view({3.9, 0.05, 3.9}, {0, 0, 0}, 96, 64)};
  shadows(c, scene, views);
  turn(scene, views, glm::rotate(dmat4(1), 0.7, glm::normalize(dvec3(1, 2, 3))));
  shadows(c, scene, views);
}

void lights_behind_the_eye(Check& c) {
  Scene scene = furnished_floor();
  const View view = of_the_floor();
  const dvec3 back = glm::transpose(glm::dmat3(view.view_from_world))[2];
  for (const double w : {0.0, 1e-30, 1e-7, 0.01, 0.5, 2.0, 20.0}) {
    for (const double side : {0.0, 1.0, -3.0})
      add_lamp(scene, view.eye + back * w + dvec3(side, side / 8, -side));
  }
  shadows(c, scene, {view}, mostly_seen);
}

// The eye sees all that its own light reaches.
void a_light_at_the_eye(Check& c) {
  Random random(3);
  Scene scene = furnished_floor();
  add_triangles(scene, sliver_soup(random, 60), glm::translate(dmat4(1), dvec3(0, 1.5, 0)));
  const std::vector<View> views = {of_the_floor(), shadow_view({-3, 1, 2}, {0, 0.5, 0})};
  add_lamp(scene, views[0].eye);
  shadows(c, scene, {views[0]}, {.seen = 0.9, .hidden = 0});
  shadows(c, scene, {views[1]}, {.seen = 0.3, .hidden = 0.02});
}

void convex_pieces(Check& c) {
  Scene scene = empty_shadow_scene();
  for (const float radius : {1.0f, 0.1f, 0.01f}) {
    ShadowTriangles triangles;
    constexpr int rings = 24;
    const auto at = [&](int i, int k) {
      const double a = i * std::numbers::pi / rings, b = k * std::numbers::pi / rings;
      return vec3(dvec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)) * double(radius));
    };
    for (int i = 0; i < rings; ++i) {
      for (int k = 0; k < 2 * rings; ++k) {
        triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
        triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
      }
    }
    add_triangles(scene, triangles, glm::translate(dmat4(1), dvec3(1.2 - radius, 0, radius)));
  }
  Random random(5);
  for (int i = 0; i < 20; ++i) add_lamp(scene, 3.0 * any_direction(random));
  shadows(c, scene,
          {shadow_view({0.5, 0.4, 3}, {0.5, 0, 0}, 96, 64), shadow_view({1.2, 0.2, 0.9}, {1.1, 0, 0})});
}

// Strips whose edges lie half way between a lamp and pixels' centres: each segment meets an edge.
void through_shared_edges(Check& c) {
  for (const bool slanted : {false, true}) {
    Scene scene = empty_shadow_scene();
    add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}));
    ShadowTriangles roof;
    for (int i = 0; i < 128; ++i) {
      const float x = -2 + float(i) / 32, next = x + 1 / 32.0f, lean = slanted ? 0.4f : 0;
      roof.push_back({vec3(x, 1, 2), vec3(next, 1, 2), vec3(next + lean, 1 + lean / 4, -2)});
      roof.push_back({vec3(x, 1, 2), vec3(next + lean, 1 + lean / 4, -2), vec3(x + lean, 1 + lean / 4, -2)});
    }
    add_triangles(scene, roof);
    for (int i = 0; i < 8; ++i) add_lamp(scene, {-1.96875 + i * 0.5, 2, 0.03125});
    Camera camera = look_at({0, 0.5, 0}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height_m = 4;
    camera.near_m = 0.1;
    camera.far_m = 2;
    shadows(c, scene, {make_view(camera, 128, 128)}, {.seen = 0.05, .hidden = 0.5, .either = 0.03});
  }
}

void through_shared_vertices(Check& c) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}));
  ShadowTriangles fan;
  constexpr int count = 500;
  for (int i = 0; i < count; ++i) {
    const auto at = [&](int k) {
      const double angle = 2 * std::numbers::pi * (k % count) / count;
      return vec3(float(std::cos(angle)), 1 + 0.1f * float(k % 2), float(std::sin(angle)));
    };
    fan.push_back({vec3(0, 1, 0), at(i), at(i + 1)});
  }
  add_triangles(scene, fan);
  for (int i = 0; i < 20; ++i) add_lamp(scene, {0.05 * i, 2, -0.03 * i});
  shadows(c, scene, {shadow_view({0, 0.9, 0.2}, {0, 0, 0}, 96, 96), shadow_view({3, 0.5, 3}, {0, 0, 0})});
}

void soup(Check& c, const ShadowTriangles& triangles, Random& random, const Shows& shows = {}) {
  shadows(c, soup_scene(triangles, random, 24), of_the_soup(), shows);
}
void shadows_of_slivers(Check& c) {
  Random random(7);
  soup(c, sliver_soup(random, 400), random);
}
void shadows_of_duplicates(Check& c) {
  Random random(11);
  soup(c, duplicate_soup(random, 80), random);
}
void shadows_of_coplanar_pieces(Check& c) {
  Random random(13);
  soup(c, coplanar_soup(random, 30), random);
}
void shadows_at_t_junctions(Check& c) {
  Random random(17);
  soup(c, junction_soup(random, 9), random);
}
void tiny_beside_huge(Check& c) {
  Random random(19);
  soup(c, soup_of_all_sizes(random, 200), random, {.either = 0.2});
}

void lights_on_casters(Check& c) {
  Random random(23);
  const ShadowTriangles triangles = coplanar_soup(random, 20);
  Scene scene = soup_scene(triangles, random, 0, 40);
  for (size_t i = 0; i < 40; i += 2) scene.lights[i].position += 1e-3 * any_direction(random);
  shadows(c, scene, of_the_soup(), {.either = 0.3});
}

void lights_at_vertices(Check& c) {
  Random random(29);
  ShadowTriangles triangles = junction_soup(random, 6);
  Scene scene = soup_scene(triangles, random, 0);
  for (size_t i = 0; i < triangles.size(); i += 2) {
    add_lamp(scene, dvec3(triangles[i][i % 3]));
    add_lamp(scene, dvec3(triangles[i][i % 3]) + 1e-3 * any_direction(random));
  }
  shadows(c, scene, of_the_soup(), {.either = 0.5});
}

// In the planes of walls, and of the faces of a box on the way.
void lights_in_planes(Check& c) {
  Scene scene = furnished_floor();
  add_triangles(scene, quad_of({-4, 0, -4}, {8, 0, 0}, {0, 3, 0}, 4, 2));
  for (const double x : {-1.0, -0.5, 1.5, 2.0}) {
    for (const double y : {0.75, 2.0, 2.5}) {
      for (const double z : {-3.0, -1.0, -0.5, 1.0}) add_lamp(scene, {x, y, z});
    }
  }
  shadows(c, scene, {of_the_floor()}, {.either = 0.3});
}

void inside_closed_boxes(Check& c) {
  Scene scene = furnished_floor();
  add_triangles(scene, box_of({1, 1, -2}, {2, 2, -1}));
  add_triangles(scene, box_of({1.25f, 1.25f, -1.75f}, {1.75f, 1.75f, -1.25f}));
  for (int i = 0; i < 8; ++i) add_lamp(scene, {1.3 + 0.05 * i, 1.5, -1.5 + 0.03 * i});
  for (int i = 0; i < 4; ++i) add_lamp(scene, {1.1, 1.1 + 0.1 * i, -1.1});
  shadows(c, scene, {of_the_floor()}, {.seen = 0, .hidden = 0.99, .either = 0.01});
  shadows(c, scene,
          {shadow_view({1.05, 1.9, -1.05}, {2, 1, -2}), shadow_view({1.3, 1.7, -1.3}, {1.7, 1.2, -1.7})});
}

// A closed box of six instances of one square, some of them mirrored: no light passes between two of them.
void box_of_instances(Check& c) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-6, -3, 6}, {12, 0, 0}, {0, 0, -12}));
  const ShadowTriangles square = quad_of({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5, 3);
  for (int side = 0; side < 6; ++side) {
    dmat4 m(0);
    const int axis = side / 2;
    m[0][(axis + 1) % 3] = side % 2 ? -1 : 1;
    m[1][(axis + 2) % 3] = 1;
    m[2][axis] = 1;
    m[3][3] = 1;
    m[3][axis] = side % 2 ? 1 : -1;
    add_triangles(scene, square, m);
  }
  Random random(31);
  for (int i = 0; i < 24; ++i) add_lamp(scene, in_cube(random, 0.99));
  shadows(c, scene, {shadow_view({4, 3, 5}, {0, -1, 0})}, {.seen = 0, .hidden = 0.98, .either = 0.02});
  shadows(c, scene, {shadow_view({0.9, 0.9, 0.9}, {-1, -1, -1})}, all_seen);
}

// Ranges that end where a caster or a receiver is.
void ranges_that_end_there(Check& c) {
  Scene scene = furnished_floor();
  for (int i = 0; i < 10; ++i) {
    const double y = 1.5 + 0.1 * i;
    for (const float range : {float(y), std::nextafter(float(y), 9.0f), float(y) - 0.75f, float(y) - 0.75001f,
                              float(std::sqrt(y * y + 0.25))})
      add_lamp(scene, {0.5 + 0.05 * i, y, 0.4}, range);
  }
  shadows(c, scene, {of_the_floor(96, 64)});
}

// Leaves of paper 0.1 to 3 mm above the floor: within the last millimetre of a segment they hide nothing.
void within_the_gap(Check& c) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}));
  for (int i = 0; i < 30; ++i)
    add_triangles(
        scene, quad_of({-1.5f + 0.1f * float(i), 0.0001f * float(i + 1), 0.5f}, {0.08f, 0, 0}, {0, 0, -1}));
  for (int i = 0; i < 16; ++i) add_lamp(scene, {-2 + 0.25 * i, 0.02 + 0.1 * i, 0.1 * i});
  shadows(c, scene,
          {shadow_view({0, 0.004, 0.9}, {0, -0.02, -0.2}, 128, 64), shadow_view({0, 2, 1}, {0, 0, 0})},
          {.hidden = 0.003});
}

// Lights nearer to the surface than the gap.
void within_the_gap_of_the_light(Check& c) {
  Scene scene = furnished_floor();
  for (int i = 0; i < 20; ++i) add_lamp(scene, {-1.6 + 0.02 * i, std::pow(10.0, -1 - 0.3 * i), 0.3});
  shadows(c, scene, {shadow_view({-1.3, 0.03, 0.4}, {-1.4, 0, 0.3}, 96, 64), of_the_floor()},
          {.hidden = 0.01, .either = 0.4});
}

void far_away(Check& c, double metres, const Shows& shows = {}) {
  Random random(37);
  Scene scene = soup_scene(sliver_soup(random, 150), random, 24);
  std::vector<View> views = of_the_soup();
  const std::vector<ShadowImage> here = shadows(c, scene, views, shows);
  const dvec3 far(metres, -metres / 2, metres * 2);
  for (Instance& instance : scene.instances) instance.world_from_object[3] += glm::dvec4(far, 0);
  for (Light& light : scene.lights) light.position += far;
  for (View& view : views) view.eye += far;
  const std::vector<ShadowImage> there = shadows(c, scene, views, shows);
  // Both moved by the same doubles, if not one of them is rounded.
  if (metres != std::exp2(20)) return;
  for (size_t i = 0; i < there.size(); ++i)
    c.that(here[i].triangles == there[i].triangles, "view {} shows other triangles far away", i);
}
void far_by_1e5_m(Check& c) { far_away(c, 1e5); }
void far_by_1e6_m(Check& c) { far_away(c, std::exp2(20)); }
void far_by_1e8_m(Check& c) { far_away(c, 1e8); }

// Where the instance is, positions are 4 mm to 1 m apart. The others keep their shadows to the bit.
void one_far_off(Check& c) {
  Random random(41);
  Scene scene = soup_scene(junction_soup(random, 8), random, 24);
  const std::vector<View> views = of_the_soup();
  const std::vector<ShadowImage> alone = shadows(c, scene, views);
  add_triangles(scene, box_of({-1, -1, -1}, {1, 1, 1}));
  for (const double metres : {1e5, 1e6, 1e7}) {
    scene.instances.back().world_from_object[3] = {metres, -metres / 3, metres / 7, 1};
    const std::vector<ShadowImage> with_far = shadows(c, scene, views);
    for (size_t i = 0; i < with_far.size(); ++i) {
      const std::string changed = difference(alone[i], with_far[i]);
      c.that(changed.empty(), "view {}: {} change with an instance {} m away", i, changed, metres);
    }
  }
}

std::vector<dmat4> mirrored_places() {
  std::vector<dmat4> made;
  for (int i = 0; i < 8; ++i) {
    dmat4 m = glm::scale(dmat4(1), dvec3(i & 1 ? -1 : 1, i & 2 ? -1 : 1, i & 4 ? -1 : 1) * 0.5);
    m[3] = glm::dvec4(i & 1 ? 1.5 : -1.5, i & 2 ? 1.5 : -1.5, i & 4 ? 1.5 : -1.5, 1);
    made.push_back(m);
  }
  return made;
}
void mirrored_instances(Check& c) {
  Random random(43);
  Scene scene = soup_scene(coplanar_soup(random, 6), random, 24);
  const int mesh = scene.instances[0].mesh;
  for (const dmat4& m : mirrored_places()) scene.instances.push_back({"mirrored", mesh, m});
  shadows(c, scene, of_the_soup());
}

void scaled_and_sheared_instances(Check& c) {
  Random random(47);
  Scene scene = soup_scene(sliver_soup(random, 120), random, 24);
  const int mesh = scene.instances[0].mesh;
  for (int i = 0; i < 8; ++i) {
    dmat4 m(1);
    for (int k = 0; k < 3; ++k) m[k] = glm::dvec4(in_cube(random, 0.6), 0);
    m[i % 3] *= std::pow(10.0, -i % 4);
    m[3] = glm::dvec4(in_cube(random, 1), 1);
    scene.instances.push_back({"scaled", mesh, m});
  }
  shadows(c, scene, of_the_soup(), {.either = 0.1});
}

void masked_foliage(Check& c) {
  Random random(53);
  Scene scene = furnished_floor();
  for (int i = 0; i < 30; ++i) {
    dmat4 m = glm::rotate(dmat4(1), double(random.uniform(0, 6)), any_direction(random));
    m[3] = glm::dvec4(in_cube(random, 1.5) + dvec3(0, 1.8, 0), 1);
    add_triangles(scene, quad_of({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), m, 1);
  }
  for (int i = 0; i < 24; ++i) add_lamp(scene, in_cube(random, 2) + dvec3(0, 2.5, 0));
  for (const float cutoff : {0.5f, 0.0f, 1.01f}) {
    scene.materials[1].alpha_cutoff = cutoff;
    shadows(c, scene, {of_the_floor(), shadow_view({-2, 3, -3}, {0, 1, 0})}, {.either = 0.15});
  }
}

// These do not hide: blended surfaces, instances that cast no shadow, and all from lights that do not cast.
void what_does_not_hide(Check& c) {
  Random random(59);
  Scene scene = furnished_floor();
  add_triangles(scene, quad_of({-3, 2.5f, 3}, {6, 0, 0}, {0, 0, -6}, 2, 2), dmat4(1), 2);
  add_triangles(scene, quad_of({-3, 2.25f, 3}, {3, 0, 0}, {0, 0, -6}, 2, 2)).casts_shadow = false;
  for (int i = 0; i < 60; ++i) add_lamp(scene, dvec3(0, 3, 0) + in_cube(random, 2)).casts_shadow = i % 3 != 0;
  shadows(c, scene, {of_the_floor()}, mostly_seen);
}

// Triangles without area, and such that rounding makes flat.
void without_area(Check& c) {
  Random random(61);
  Scene scene = furnished_floor();
  ShadowTriangles flat;
  for (int i = 0; i < 200; ++i) {
    const vec3 a = vec3(in_cube(random, 1.5)) + vec3(0, 1.5f, 0), b = vec3(in_cube(random, 1));
    flat.push_back({a, a, a});
    flat.push_back({a, a + b, a});
    flat.push_back({a, a + b, a + b * 0.5f});
    flat.push_back({a, a + b * 1e-20f, a - b * 1e-20f});
    flat.push_back({a, a + b, a + b * 1.0001f});
  }
  add_triangles(scene, flat);
  for (int i = 0; i < 24; ++i) add_lamp(scene, in_cube(random, 2) + dvec3(0, 2.2, 0));
  shadows(c, scene, {of_the_floor()}, {.seen = 0.3, .hidden = 0.02, .either = 0.1});
}

}  // namespace

std::vector<CaseRun> shadow_cases() {
  std::vector<CaseRun> cases = CASES(
      grazing, lights_behind_the_eye, a_light_at_the_eye, convex_pieces, through_shared_edges,
      through_shared_vertices, shadows_of_slivers, shadows_of_duplicates, shadows_of_coplanar_pieces,
      shadows_at_t_junctions, tiny_beside_huge, lights_on_casters, lights_at_vertices, lights_in_planes,
      inside_closed_boxes, box_of_instances, ranges_that_end_there, within_the_gap,
      within_the_gap_of_the_light, far_by_1e5_m, far_by_1e6_m, far_by_1e8_m, one_far_off, mirrored_instances,
      scaled_and_sheared_instances, masked_foliage, what_does_not_hide, without_area);
  for (const auto& more : {shadow_cases_of_views(), shadow_cases_of_contacts()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

}  // namespace lightgrid::lab::verify
