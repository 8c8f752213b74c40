// A camera in the room of a scene without one.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "base/facing.h"
#include "scene/camera.h"

namespace lightgrid {
namespace {

using Corners = std::array<glm::dvec3, 3>;  // world

std::vector<Corners> triangles_of(const Scene& scene, size_t most) {
  std::vector<Corners> triangles;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (triangles.size() + mesh.indices.size() / 3 > most) return {};
    const bool mirrored = is_mirroring(glm::dmat3(instance.world_from_object));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Corners& corners = triangles.emplace_back();
      for (size_t c = 0; c < 3; ++c) {
        corners[mirrored ? 2 - c : c] =
            glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[mesh.indices[i + c]], 1));
      }
    }
  }
  return triangles;
}

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  bool front = false;
};

// Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
Hit hit_of(const Corners& triangle, const glm::dvec3& from, const glm::dvec3& direction) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
  const double volume = glm::dot(ab, p);
  if (volume == 0) return {};
  const glm::dvec3 at = from - a;
  const double u = glm::dot(at, p) / volume;
  if (!(u >= 0 && u <= 1)) return {};
  const glm::dvec3 q = glm::cross(at, ab);
  const double v = glm::dot(direction, q) / volume, t = glm::dot(ac, q) / volume;
  return v >= 0 && u + v <= 1 && t > 0 ? Hit{t, volume > 0} : Hit{};
}

Hit nearest_hit(const std::vector<Corners>& triangles, const glm::dvec3& from, const glm::dvec3& direction) {
  Hit nearest;
  for (const Corners& triangle : triangles) {
    const Hit hit = hit_of(triangle, from, direction);
    if (hit.distance < nearest.distance) nearest = hit;
  }
  return nearest;
}

// The triangles that touch the height: rays at it can meet no other.
std::vector<Corners> at_height(const std::vector<Corners>& triangles, double y) {
  std::vector<Corners> at;
  std::ranges::copy_if(triangles, std::back_inserter(at), [&](const Corners& t) {
    return std::min({t[0].y, t[1].y, t[2].y}) <= y && std::max({t[0].y, t[1].y, t[2].y}) >= y;
  });
  return at;
}

constexpr int directions = 16;  // level ones

glm::dvec3 level_direction(int i) {
  const double angle = 2 * std::numbers::pi * i / directions;
  return {std::cos(angle), 0, std::sin(angle)};
}

// Returns whether the floor continues at its height to near the walls on at least half of the sides. Bodies
// that are hollow and wound inwards, as some files' animals, have a round bottom instead.
bool has_level_floor(const std::vector<Corners>& triangles, const glm::dvec3& eye, double ground,
                     const std::array<double, directions>& distance) {
  constexpr double near_wall = 0.9, tolerance = 0.25;  // relative to the distance, and to the eye's height
  const double height = eye.y - ground;
  int level = 0;
  for (int i = 0; i < directions; ++i) {
    const glm::dvec3 from = eye + level_direction(i) * (near_wall * distance[size_t(i)]);
    level += std::abs(nearest_hit(triangles, from, {0, -1, 0}).distance - height) <= tolerance * height;
  }
  return level >= directions / 2;
}

struct Walls {
  bool any = false, outward = false;  // the outermost has its front outside
  bool several = false;               // another front lies behind the nearest
};

Walls walls_along(const std::vector<Corners>& triangles, const glm::dvec3& eye, const glm::dvec3& direction) {
  std::vector<Hit> hits;
  for (const Corners& triangle : triangles) {
    const Hit hit = hit_of(triangle, eye, direction);
    if (std::isfinite(hit.distance)) hits.push_back(hit);
  }
  if (hits.empty()) return {};
  std::ranges::sort(hits, {}, &Hit::distance);
  // Surfaces in the same place are two sides of one wall, or neighbours that share the edge.
  const double same = 1e-6 * hits.back().distance;
  const auto first_front = std::ranges::find(hits, true, &Hit::front);
  return {true,
          std::any_of(hits.begin(), hits.end(),
                      [&](const Hit& h) { return !h.front && h.distance >= hits.back().distance - same; }),
          std::any_of(first_front, hits.end(),
                      [&](const Hit& h) { return h.front && h.distance > first_front->distance + same; })};
}

// Returns whether the eye is in the cavity of an object made to be seen from outside: nearly all outermost
// surfaces face out, and the cavity is empty: few rays meet another front behind the first, and none of the
// scene's lights is in it.
bool in_hollow_object(const Scene& scene, const std::vector<Corners>& triangles, const glm::dvec3& eye) {
  constexpr int rays = 64;
  constexpr double nearly_all = 0.9, few = 0.2, golden_angle = 2.399963229728653;
  int any = 0, outward = 0, several = 0;
  for (int i = 0; i < rays; ++i) {  // evenly over the sphere
    const double up = 1 - (2 * i + 1.0) / rays, across = std::sqrt(1 - up * up), turn = golden_angle * i;
    const Walls walls = walls_along(triangles, eye, {across * std::cos(turn), up, across * std::sin(turn)});
    any += walls.any;
    outward += walls.outward;
    several += walls.several;
  }
  if (outward < nearly_all * any || several > few * any) return false;
  constexpr ptrdiff_t max_lights = 16;
  const auto end = scene.lights.begin() + std::min(max_lights, std::ssize(scene.lights));
  return std::none_of(scene.lights.begin(), end, [&](const Light& light) {
    return !is_directional(light) && nearest_hit(triangles, eye, light.position - eye).distance > 1;
  });
}

struct RoomPlace {
  Camera camera;
  glm::dvec3 eye{0};
};

// A camera in the room around a place, if there is one.
std::optional<RoomPlace> camera_at(const std::vector<Corners>& triangles, const glm::dvec3& place,
                                   double top) {
  constexpr int walls = 14;
  constexpr double eye_height_m = 1.7, min_height_m = 1, free_m = 1.5, back = 0.8;
  const Hit floor = nearest_hit(triangles, place, {0, -1, 0});
  if (!floor.front || !std::isfinite(floor.distance)) return {};
  const double ground = place.y - floor.distance;
  const glm::dvec3 eye(place.x, ground + std::min(eye_height_m, 0.65 * (top - ground)), place.z);
  if (eye.y - ground < min_height_m) return {};
  const std::vector<Corners> level = at_height(triangles, eye.y);
  std::array<double, directions> distance;
  int count = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < directions; ++i) {
    const Hit wall = nearest_hit(level, eye, level_direction(i));
    distance[size_t(i)] = wall.front ? wall.distance : 0;
    count += wall.front && std::isfinite(wall.distance);
    least = std::min(least, wall.distance);
  }
  if (count < walls || least < free_m || !has_level_floor(triangles, eye, ground, distance)) return {};
  int longest = 0;
  const auto length = [&](int i) {
    return distance[size_t(i)] + distance[size_t((i + directions / 2) % directions)];
  };
  for (int i = 1; i < directions; ++i) {
    if (length(i) > length(longest)) longest = i;
  }
  const glm::dvec3 forward = level_direction(longest);
  const double behind = distance[size_t((longest + directions / 2) % directions)];
  const glm::dvec3 stands = eye - forward * (back * behind);
  Camera camera = look_at(stands, stands + forward);
  camera.name = "room";
  return RoomPlace{camera, eye};
}

}  // namespace

std::optional<Camera> room_camera(const Scene& scene) {
  constexpr size_t max_triangles = 2'000'000;
  const WorldBox box = world_box(scene);
  if (box.empty()) return {};
  const glm::dvec3 size = box.max - box.min;
  if (!(size.x >= 3 && size.y >= 2 && size.z >= 3 && glm::length(size) < 1e6)) return {};
  const std::vector<Corners> triangles = triangles_of(scene, max_triangles);
  for (const double x : {0.5, 0.35, 0.65}) {
    for (const double z : {0.5, 0.35, 0.65}) {
      const auto found = camera_at(triangles, box.min + size * glm::dvec3(x, 0.5, z), box.max.y);
      if (found && in_hollow_object(scene, triangles, found->eye)) return {};
      if (found) return found->camera;
    }
  }
  return {};
}

}  // namespace lightgrid
