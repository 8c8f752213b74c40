// A camera in the room of a scene without one.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "scene/camera.h"

namespace lightgrid {
namespace {

using Corners = std::array<glm::dvec3, 3>;  // world

std::vector<Corners> triangles_of(const Scene& scene, size_t most) {
  std::vector<Corners> triangles;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (triangles.size() + mesh.indices.size() / 3 > most) return {};
    const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0;
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
Hit nearest_hit(const std::vector<Corners>& triangles, const glm::dvec3& from, const glm::dvec3& direction) {
  Hit nearest;
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
    const double volume = glm::dot(ab, p);
    if (volume == 0) continue;
    const glm::dvec3 at = from - a;
    const double u = glm::dot(at, p) / volume;
    if (!(u >= 0 && u <= 1)) continue;
    const glm::dvec3 q = glm::cross(at, ab);
    const double v = glm::dot(direction, q) / volume, t = glm::dot(ac, q) / volume;
    if (v >= 0 && u + v <= 1 && t > 0 && t < nearest.distance) nearest = {t, volume > 0};
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

// A camera in the room around a place, if there is one.
std::optional<Camera> camera_at(const std::vector<Corners>& triangles, const glm::dvec3& place, double top) {
  constexpr int directions = 16, walls = 14;
  constexpr double eye_height_m = 1.7, least_height_m = 1, free_m = 1.5, back = 0.8;
  const Hit floor = nearest_hit(triangles, place, {0, -1, 0});
  if (!floor.front || !std::isfinite(floor.distance)) return {};
  const double ground = place.y - floor.distance;
  const glm::dvec3 eye(place.x, ground + std::min(eye_height_m, 0.65 * (top - ground)), place.z);
  if (eye.y - ground < least_height_m) return {};
  const std::vector<Corners> level = at_height(triangles, eye.y);
  std::array<double, directions> distance;
  int count = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto direction_of = [](int i) {
    const double angle = 2 * std::numbers::pi * i / directions;
    return glm::dvec3(std::cos(angle), 0, std::sin(angle));
  };
  for (int i = 0; i < directions; ++i) {
    const Hit wall = nearest_hit(level, eye, direction_of(i));
    distance[size_t(i)] = wall.front ? wall.distance : 0;
    count += wall.front && std::isfinite(wall.distance);
    least = std::min(least, wall.distance);
  }
  if (count < walls || least < free_m) return {};
  int longest = 0;
  const auto length = [&](int i) {
    return distance[size_t(i)] + distance[size_t((i + directions / 2) % directions)];
  };
  for (int i = 1; i < directions; ++i) {
    if (length(i) > length(longest)) longest = i;
  }
  const glm::dvec3 forward = direction_of(longest);
  const double behind = distance[size_t((longest + directions / 2) % directions)];
  const glm::dvec3 stands = eye - forward * (back * behind);
  Camera camera = look_at(stands, stands + forward);
  camera.name = "room";
  return camera;
}

}  // namespace

std::optional<Camera> room_camera(const Scene& scene) {
  constexpr size_t most_triangles = 2'000'000;
  const WorldBox box = world_box(scene);
  if (box.empty()) return {};
  const glm::dvec3 size = box.max - box.min;
  if (!(size.x >= 3 && size.y >= 2 && size.z >= 3 && glm::length(size) < 1e6)) return {};
  const std::vector<Corners> triangles = triangles_of(scene, most_triangles);
  for (const double x : {0.5, 0.35, 0.65}) {
    for (const double z : {0.5, 0.35, 0.65}) {
      const auto found = camera_at(triangles, box.min + size * glm::dvec3(x, 0.5, z), box.max.y);
      if (found) return found;
    }
  }
  return {};
}

}  // namespace lightgrid
