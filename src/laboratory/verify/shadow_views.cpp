// Hard cases of exact shadows: how eye, light and surface lie to each other, kinds of views, and lists of
// lights.
#include <algorithm>
#include <cmath>

#include "scenes/compose.h"
#include "verify/shadow_check.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

// Thin sheets that eye and light see from different sides, and lights close to the sheet's plane.
void seen_from_behind(Check& c) {
  Scene scene = empty_shadow_scene();
  for (int i = 0; i < 6; ++i)
    add_triangles(scene,
                  quad_of({-2 + 0.7f * float(i), -1, 0.2f * float(i)}, {0.6f, 0, -0.2f}, {0, 2, 0.1f}, 2, 2));
  Random random(67);
  for (int i = 0; i < 40; ++i) add_lamp(scene, dvec3(0, 0, i % 2 ? 2 : -2) + in_cube(random, 1.8));
  shadows(c, scene, {shadow_view({0.2, 0.1, 3}, {0, 0, 0}), shadow_view({0.2, 0.1, -3}, {0, 0, 0})},
          {.seen = 0.1, .hidden = 0.2});
}

void at_the_own_plane(Check& c) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, quad_of({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 3, 3));
  for (int i = 0; i < 24; ++i) {
    const double height = (i % 2 ? -1 : 1) * std::pow(10.0, -0.25 * i);
    add_lamp(scene, {1.5 * std::cos(i), height, 1.5 * std::sin(i)});
  }
  shadows(c, scene, {shadow_view({0.5, 2, 2.5}, {0, 0, 0}), shadow_view({0.5, -1e-3, 2.5}, {0, 0, 0})},
          {.seen = 0.3, .hidden = 0.3, .either = 0.2});
}

void in_orthographic_views(Check& c) {
  Random random(71);
  const Scene scene = soup_scene(sliver_soup(random, 150), random, 24);
  for (const double half : {0.1, 2.5, 40.0}) {
    Camera camera = look_at({0.5, 2.2, 1}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height_m = half;
    camera.near_m = -20;
    camera.far_m = 30;
    shadows(c, scene, {make_view(camera, 80, 60)}, {.hidden = 0.005});
  }
}

void standard_far_planes(Check& c) {
  Random random(73);
  const Scene scene = soup_scene(junction_soup(random, 9), random, 24);
  std::vector<View> views;
  for (const double far_m : {7.0, 8.5, 1e4}) {
    for (const double near_m : {1e-4, 0.1}) {
      Camera camera = look_at({3, 2, 4}, {0, 0, 0});
      camera.near_m = near_m;
      camera.far_m = far_m;
      views.push_back(make_view(camera, 48, 36));
    }
  }
  shadows(c, scene, views);
}

void narrow_and_wide_views(Check& c) {
  Random random(79);
  const Scene scene = soup_scene(sliver_soup(random, 200), random, 24);
  shadows(c, scene,
          {shadow_view({3, 2, 4}, {0, 0, 0}, 64, 48, 0.004), shadow_view({0, 1, 0}, {1, -1, 1}, 64, 48, 2.9),
           shadow_view({3000, 2000, 4000}, {0, -1, 0}, 64, 48, 0.001)},
          {.either = 0.4});
}

void shadows_in_32_bits(Check& c) {
  Random random(83);
  Scene scene = furnished_floor();
  for (int i = 0; i < 66'000; ++i) {
    const bool casts = i % 1999 == 7 || i > 65'990;
    add_lamp(scene, casts ? dvec3(0, 2.5, 0) + in_cube(random, 2) : dvec3(0, 60, 0) + in_cube(random, 1),
             casts ? 20.0f : 0.5f)
        .casts_shadow = casts;
  }
  shadows(c, scene, {of_the_floor(40, 30)});
}

void long_lists(Check& c) {
  Random random(89);
  Scene scene = furnished_floor();
  for (int i = 0; i < 2500; ++i) add_lamp(scene, dvec3(0, 2, 0) + in_cube(random, 1.9));
  shadows(c, scene, {of_the_floor(20, 18)});
}

void around_32_lights(Check& c) {
  Random random(97);
  for (const int count : {1, 31, 32, 33, 63, 65}) {
    Scene scene = furnished_floor();
    for (int i = 0; i < count; ++i) add_lamp(scene, dvec3(0, 2.5, 0) + in_cube(random, 2));
    shadows(c, scene, {of_the_floor(40, 30)}, {.seen = 0.02, .hidden = 0.01});
  }
}

void cut_tiles(Check& c) {
  Random random(101);
  Scene scene = furnished_floor(9);
  for (int i = 0; i < 20; ++i) add_lamp(scene, dvec3(0, 2, 0) + in_cube(random, 1.9));
  std::vector<View> views;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {17, 9}, {1, 33}, {33, 1}, {65, 63}, {31, 47}, {15, 16}})
    views.push_back(of_the_floor(width, height));
  shadows(c, scene, views);
}

// Pixels that show nothing, in tiles that show something and in others; a view of nothing at all.
void sky_between(Check& c) {
  Random random(103);
  Scene scene = empty_shadow_scene();
  add_triangles(scene, sliver_soup(random, 40));
  add_triangles(scene, box_of({-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}));
  for (int i = 0; i < 20; ++i) add_lamp(scene, in_cube(random, 2.5));
  shadows(c, scene,
          {shadow_view({3, 2, 4}, {0, 0, 0}, 80, 70), shadow_view({3, 2, 4}, {6, 4, 8}, 40, 30),
           shadow_view({-3, 2, 4}, {0, 0, 0}, 80, 70)});
}

// Cones whose side lies on what they light, also as wide as a half-space and wider.
void edges_of_cones(Check& c) {
  Random random(107);
  Scene scene = furnished_floor();
  for (int i = 0; i < 40; ++i) {
    const float angles[] = {0.01f, 0.3f, 0.8f, 1.5707963f, 1.6f, 2.5f, 3.1415925f};
    const dvec3 at = dvec3(0, 2.2, 0) + in_cube(random, 1.5);
    add_spot_lamp(scene, at, dvec3(in_cube(random, 1.5).x, 0, in_cube(random, 1.5).z), angles[i % 7]);
  }
  shadows(c, scene, {of_the_floor(96, 64)});
}

// The rasteriser takes the depths of triangles that are thinner than its snapping from their snapped corners.
// Here the eye is close to a floor of strips along which depth stays the same: that moves positions off the
// floor by up to 0.2 mm, in one of the two views away from the eye. On the floor's other side than the eye
// lie, for many pixels, a lamp whose range ends at the pixel's place, 0.05 mm before it or behind it, and a
// spot whose cone ends there. up: 1 or -1, where those are.
void beside_their_plane_from(Check& c, double up) {
  Scene scene = empty_shadow_scene();
  add_triangles(scene, box_of({-0.25f, -1, -0.25f}, {0.25f, 1, 0.25f}));
  add_triangles(scene, quad_of({-4, 0, -0.5f}, {8, 0, 0}, {0, 0, -2.25f}, 1, 4500));
  const View view =
      shadow_view({-1.284856, -0.1038504 * up, -3.4913974}, {-1.284856, 0.3 * up, -0.25}, 80, 24, 1.126);
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; x += 5) {
      const dvec3 way =
          world_from_view * dvec3((2 * (x + 0.5) / view.width - 1) / view.clip_from_view[0][0],
                                  (2 * (y + 0.5) / view.height - 1) / view.clip_from_view[1][1], -1);
      const dvec3 foot = view.eye - way * (view.eye.y / way.y);
      const double away = foot.z - view.eye.z;
      if (way.y * up <= 0 || away < 0.8 || away > 2.9 || std::abs(foot.x) > 4) continue;
      const double height = x % 2 ? 0.5 : 1, ends[] = {0, -5e-5, 5e-5};
      add_lamp(scene, foot + dvec3(0, height * up, 0), float(height + ends[(x / 5 + y) % 3]));
      const dvec3 beside = foot + dvec3(-0.2, 0.7 * up, 0.1);
      add_spot_lamp(scene, beside, foot + dvec3(0.3, 0, 0.4), 0.1f, 3);
      Light& spot = scene.lights.back();
      spot.outer_cone_rad =
          float(std::acos(glm::dot(glm::normalize(foot - beside), glm::normalize(dvec3(spot.direction)))));
      spot.inner_cone_rad = spot.outer_cone_rad / 2;
    }
  }
  shadows(c, scene, {view});
}
void beside_their_plane(Check& c) {
  beside_their_plane_from(c, 1);
  beside_their_plane_from(c, -1);
}

}  // namespace

std::vector<CaseRun> shadow_cases_of_views() {
  return CASES(seen_from_behind, at_the_own_plane, in_orthographic_views, standard_far_planes,
               narrow_and_wide_views, shadows_in_32_bits, long_lists, around_32_lights, cut_tiles,
               sky_between, edges_of_cones, beside_their_plane);
}

}  // namespace lightgrid::lab::verify
