#include "verify/hunt_shadow_space.h"

#include <cmath>
#include <numbers>

#include "scenes/compose.h"
#include "verify/chosen_by_name.h"
#include "verify/shadow_scenes.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

int count_of(Random& random, int low, int high) {
  return low + int(random.next() % uint64_t(high - low + 1));
}

dmat4 moved_to(const dvec3& place) { return glm::translate(dmat4(1), place); }

// Half-metres, so that pieces touch, share planes and overlap.
vec3 half_metres(Random& random, float half) {
  const float x = random.uniform(-half, half), y = random.uniform(-half, half),
              z = random.uniform(-half, half);
  return glm::round(vec3(x, y, z) * 2.0f) * 0.5f;
}

ShadowTriangles with_floor(Scene& scene, ShadowTriangles triangles) {
  add_triangles(scene, triangles);
  add_triangles(scene, quad_of({-4, -2.25f, 4}, {8, 0, 0}, {0, 0, -8}, 3, 2));
  return triangles;
}

ShadowTriangles slivers_hunted(Scene& scene, Random& random) {
  return with_floor(scene, sliver_soup(random, count_of(random, 20, 500)));
}
ShadowTriangles duplicates_hunted(Scene& scene, Random& random) {
  return with_floor(scene, duplicate_soup(random, count_of(random, 5, 100)));
}
ShadowTriangles coplanar_hunted(Scene& scene, Random& random) {
  return with_floor(scene, coplanar_soup(random, count_of(random, 3, 60)));
}
ShadowTriangles junctions_hunted(Scene& scene, Random& random) {
  return with_floor(scene, junction_soup(random, count_of(random, 3, 12)));
}
ShadowTriangles sizes_hunted(Scene& scene, Random& random) {
  return with_floor(scene, soup_of_all_sizes(random, count_of(random, 41, 300)));
}

// Walls on some sides, columns of many sides, lintels on them.
ShadowTriangles rooms_hunted(Scene& scene, Random& random) {
  ShadowTriangles all =
      quad_of({-2, -1, 2}, {4, 0, 0}, {0, 0, -4}, count_of(random, 1, 8), count_of(random, 1, 8));
  if (random.next() % 2) add_quad(all, {-2, 1, 2}, {4, 0, 0}, {0, 0, -4}, 2, 3);
  if (random.next() % 2) add_quad(all, {-2, -1, -2}, {4, 0, 0}, {0, 2, 0}, 3, 1);
  if (random.next() % 2) add_quad(all, {-2, -1, 2}, {0, 0, -4}, {0, 2, 0}, 1, 4);
  for (int i = count_of(random, 1, 12); i > 0; --i) {
    const int sides = count_of(random, 3, 24);
    const float radius = random.uniform(0.02f, 0.3f);
    const vec3 foot = vec3(0, -1, 0) + half_metres(random, 2) * vec3(1, 0, 1);
    for (int k = 0; k < sides; ++k) {
      const auto at = [&](int n) {
        const double angle = 2 * std::numbers::pi * (n % sides) / sides;
        return foot + radius * vec3(float(std::cos(angle)), 0, float(std::sin(angle)));
      };
      add_quad(all, at(k), at(k + 1) - at(k), {0, 2, 0}, 1, 2);
    }
    add_box(all, foot + vec3(-0.5f, 1.5f, -0.1f), foot + vec3(0.5f, 1.75f, 0.1f));
  }
  add_triangles(scene, all);
  return all;
}

// Steps whose treads and risers are many quads of one plane.
ShadowTriangles terraces_hunted(Scene& scene, Random& random) {
  ShadowTriangles all;
  const int steps = count_of(random, 2, 7);
  for (int i = 0; i < steps; ++i) {
    const float at = -2 + 4 * float(i) / float(steps), depth = 4 / float(steps),
                rise = random.uniform(0.0f, 0.7f);
    const float y = -1 + 0.25f * float(i);
    add_quad(all, {-2, y, at + depth}, {4, 0, 0}, {0, 0, -depth}, count_of(random, 1, 40),
             count_of(random, 1, 5));
    add_quad(all, {-2, y, at + depth}, {4, 0, 0}, {0, rise, 0}, count_of(random, 1, 30), 1);
  }
  add_triangles(scene, all);
  for (int i = count_of(random, 0, 6); i > 0; --i)
    add_triangles(scene, box_of({-0.25f, 0, -0.25f}, {0.25f, 0.5f, 0.25f}),
                  moved_to(half_metres(random, 1.5f)));
  return all;
}

// Closed boxes in each other and beside each other, with common faces.
ShadowTriangles boxes_hunted(Scene& scene, Random& random) {
  ShadowTriangles all;
  for (int i = count_of(random, 1, 25); i > 0; --i) {
    const vec3 low = half_metres(random, 1.5f), size = glm::abs(half_metres(random, 1)) + vec3(0.5f);
    add_box(all, low, low + size);
    if (random.next() % 3 == 0) add_box(all, low - size * 0.25f, low + size * 1.25f);
  }
  return with_floor(scene, all);
}

ShadowTriangles foliage_hunted(Scene& scene, Random& random) {
  scene.materials[1].alpha_cutoff = random.uniform(0.05f, 1);
  const ShadowTriangles card = quad_of({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
  for (int i = count_of(random, 5, 60); i > 0; --i) {
    const dmat4 turned = glm::rotate(dmat4(1), double(random.uniform(0, 6)), any_direction(random));
    add_triangles(scene, card, moved_to(in_cube(random, 1.6)) * turned, random.next() % 6 ? 1 : 0);
  }
  return with_floor(scene, box_of({-0.25f, -2.25f, -0.25f}, {0.25f, 1, 0.25f}));
}

// Mirrored, scaled, sheared, and flat.
ShadowTriangles instances_hunted(Scene& scene, Random& random) {
  const ShadowTriangles made =
      with_floor(scene, random.next() % 2 ? coplanar_soup(random, 6)
                                          : box_of({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}));
  for (int i = count_of(random, 2, 20); i > 0; --i) {
    dmat4 m(1);
    for (int k = 0; k < 3; ++k) {
      if (i % 2)
        m[k] = glm::dvec4(in_cube(random, 0.8), 0);
      else
        m[k][k] = random.next() % 2 ? 0.5 : -0.5;
    }
    m[i % 3] *= std::pow(10.0, -double(random.next() % 5));
    m[3] = glm::dvec4(dvec3(half_metres(random, 1.5f)), 1);
    scene.instances.push_back({"instance", scene.instances[0].mesh, m});
    scene.instances.back().casts_shadow = random.next() % 8 != 0;
  }
  return made;
}

constexpr ShadowHuntClass shadow_hunt_classes[] = {
    {"slivers", slivers_hunted},
    {"duplicates", duplicates_hunted},
    {"coplanar", coplanar_hunted},
    {"junctions", junctions_hunted},
    {"sizes", sizes_hunted},
    {"rooms", rooms_hunted},
    {"terraces", terraces_hunted},
    {"boxes", boxes_hunted},
    {"foliage", foliage_hunted},
    {"instances", instances_hunted},
    {"far_soups", slivers_hunted, 1e5, 1e9},
    {"far_rooms", rooms_hunted, 1e5, 1e9},
};

dvec3 place_of_lamp(const ShadowTriangles& triangles, Random& random) {
  const ShadowTriangle& t = triangles[size_t(random.next() % triangles.size())];
  const dvec3 on = on_triangle(random, t), a(t[0]), u = dvec3(t[1]) - a, v = dvec3(t[2]) - a;
  const double x = random.uniform(-2, 3), y = random.uniform(-2, 3);
  switch (random.next() % 16) {
    case 0:
      return on;
    case 1:
      return dvec3(t[random.next() % 3]);
    case 2:
      return glm::clamp(a + u * x + v * y, dvec3(-50), dvec3(50));  // in its plane
    case 3:
      return on + any_direction(random) * std::exp2(double(random.uniform(-24, -4)));
    case 4:
      return in_cube(random, 30);
    case 5:
      return dvec3(half_metres(random, 2));
    default:
      return in_cube(random, 2.1);
  }
}

void add_lamps(Scene& scene, const ShadowTriangles& triangles, Random& random) {
  const int count = count_of(random, 1, 120);
  for (int i = 0; i < count; ++i) {
    const dvec3 at = place_of_lamp(triangles, random);
    const dvec3 target = on_triangle(random, triangles[size_t(random.next() % triangles.size())]);
    const uint64_t range = random.next() % 8;
    const float radius = range == 0   ? float(glm::length(target - at))
                         : range == 1 ? random.uniform(0.1f, 3)
                                      : 60.0f;
    if (random.next() % 4 == 0 && target != at)
      add_spot_lamp(scene, at, target, random.uniform(0.02f, 3.1f), radius);
    else
      add_lamp(scene, at, radius);
    scene.lights.back().casts_shadow = random.next() % 32 != 0;
  }
  scene.lights.front().casts_shadow = true;
}

View random_shadow_view(const ShadowTriangles& triangles, Random& random) {
  constexpr int sizes[][2] = {{128, 128}, {193, 121}, {256, 192}, {33, 17}, {320, 180}, {7, 120}};
  const auto& size = sizes[random.next() % std::size(sizes)];
  const dvec3 target = on_triangle(random, triangles[size_t(random.next() % triangles.size())]);
  const dvec3 eye = random.next() % 3 ? in_cube(random, 4)
                                      : target + any_direction(random) * double(random.uniform(0.02f, 1));
  Camera camera = look_at(eye, target);
  camera.fov_y_rad = random.uniform(0.05f, 2.6f);
  camera.near_m = std::exp2(random.uniform(-12, -3));
  if (random.next() % 5 == 0) camera.far_m = random.uniform(2, 30);
  if (random.next() % 6 == 0) {
    camera.orthographic = true;
    camera.half_height_m = std::exp2(random.uniform(-4, 3));
    camera.near_m = -20;
    camera.far_m = random.uniform(5, 60);
  }
  return make_view(camera, size[0], size[1]);
}

}  // namespace

void move_eye(View& view, const dvec3& by) {
  view.eye += by;
  view.view_from_world[3] = glm::dvec4(-(glm::dmat3(view.view_from_world) * view.eye), 1);
}

HuntedScene hunted_scene(const ShadowHuntClass& hunted, uint64_t seed) {
  Random random(Random::mix(seed));
  HuntedScene made{empty_shadow_scene(), {}};
  const ShadowTriangles triangles = hunted.make(made.scene, random);
  add_lamps(made.scene, triangles, random);
  for (int i = 0; i < 3; ++i) made.views.push_back(random_shadow_view(triangles, random));
  if (hunted.max_far_m > 0) {
    const double far_m =
        hunted.min_far_m * std::pow(hunted.max_far_m / hunted.min_far_m, double(random.uniform()));
    const dvec3 far = any_direction(random) * far_m;
    for (Instance& instance : made.scene.instances) instance.world_from_object[3] += glm::dvec4(far, 0);
    for (Light& light : made.scene.lights) light.position += far;
    for (View& view : made.views) move_eye(view, far);
  }
  return made;
}

std::vector<ShadowHuntClass> chosen_shadow_classes(const std::string& filter) {
  return chosen_by_name(
      shadow_hunt_classes, filter, [](const ShadowHuntClass& c) { return c.name; },
      "class of the hunt of shadows", "slivers or rooms");
}

}  // namespace lightgrid::lab::verify
