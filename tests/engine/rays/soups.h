// Triangles that shadow rays may fail on, with lights and points beside them.
#pragma once

#include <array>
#include <random>

#include "rays/ray_scene.h"

namespace lightgrid {

inline ClDevice& rays_device() {
  static ClDevice* const device = new ClDevice;
  return *device;
}

inline ProgramCache& rays_programs() {
  static ProgramCache* const programs = new ProgramCache(rays_device());
  return *programs;
}

using Corners = std::array<glm::vec3, 3>;

class RandomNumbers {
 public:
  explicit RandomNumbers(uint32_t seed) : numbers_(seed) {}
  double unit() { return double(numbers_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int count) { return int(unit() * count); }
  glm::dvec3 in_cube(double half) {
    return {between(-half, half), between(-half, half), between(-half, half)};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_cube(1);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1) return v / length;
    }
  }

 private:
  std::mt19937 numbers_;
};

struct Soup {
  std::string name;
  std::vector<Corners> triangles;
};

inline void add_square(Soup& soup, const glm::dvec3& a, const glm::dvec3& u, const glm::dvec3& v) {
  const glm::vec3 p[] = {glm::vec3(a), glm::vec3(a + u), glm::vec3(a + u + v), glm::vec3(a + v)};
  soup.triangles.push_back({p[0], p[1], p[2]});
  soup.triangles.push_back({p[0], p[2], p[3]});
}

// In a cube of 4 m about the origin.
inline std::vector<Soup> hard_soups(uint32_t seed = 5) {
  std::vector<Soup> soups;
  RandomNumbers random(seed);
  const auto corner = [&](double half) { return glm::vec3(random.in_cube(half)); };
  Soup plain{"Plain", {}}, slivers{"Slivers", {}}, twins{"DuplicatesAndEmptyOnes", {}},
      pieces{"CoplanarPieces", {}}, junctions{"TJunctions", {}}, tiny{"Tiny", {}};
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 at = corner(1.8f);
    plain.triangles.push_back({at, at + corner(0.4f), at + corner(0.4f)});
    const glm::vec3 along = corner(1.5f);
    const float t = float(random.unit());
    slivers.triangles.push_back(
        {at, at + along, at + along * t + corner(std::pow(10.0, random.between(-6, -1)))});
    const Corners c = {at, at + corner(0.6f), at + corner(0.6f)};
    twins.triangles.push_back(c);
    twins.triangles.push_back(i % 3 == 0 ? Corners{c[0], c[0], c[1]} : Corners{c[i % 3], c[1], c[0]});
    tiny.triangles.push_back({at, at + corner(1e-4), at + corner(1e-4)});
    tiny.triangles.push_back({at, at + corner(1.0), at + corner(1.0)});
  }
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 a = corner(1.8f), b = corner(1.8f), d = corner(1.8f);
    pieces.triangles.push_back({a, b, d});  // and parts of it, which lie in it but for rounding
    pieces.triangles.push_back({a, b, glm::mix(a, d, 0.5f)});
    pieces.triangles.push_back({glm::mix(a, b, 0.25f), glm::mix(a, b, 0.75f), d});
  }
  for (int i = 0; i < 12; ++i) {  // walls of squares whose neighbours are half as large
    const int axis = i % 3;
    glm::dvec3 u(0), v(0), at(-1.5);
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
    at[axis] = i < 3 ? 1 : i < 6 ? -1 : random.between(-2, 2);
    for (int k = 0; k < 3; ++k) add_square(junctions, at + v * double(k), u, v);
    for (int k = 0; k < 6; ++k) add_square(junctions, at + u + v * (0.5 * k), u * 0.5, v * 0.5);
  }
  for (Soup* s : {&plain, &slivers, &twins, &pieces, &junctions, &tiny}) soups.push_back(std::move(*s));
  return soups;
}

// Lights and points that go with a soup, relative to the scene's origin; triangles are too.
struct Queries {
  std::vector<RayPoint> points;
  std::vector<RayLight> lights;
  std::vector<RayPacket> packets;
};

// Sometimes on an edge, at a corner, or a little past one.
inline glm::dvec3 on_triangle(RandomNumbers& random, const Corners& c) {
  double u = random.unit(), v = random.unit();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const int edge = random.below(8);
  if (edge < 3) u = 0;
  if (edge == 1) v = random.below(2);
  if (edge == 2) v = -std::pow(10.0, random.between(-7, -1));
  const int first = random.below(3);
  return glm::dvec3(c[first]) * (1 - u - v) + glm::dvec3(c[(first + 1) % 3]) * u +
         glm::dvec3(c[(first + 2) % 3]) * v;
}

// Every fourth light is a direction; points lie on triangles, or anywhere, or in every other block behind a
// place on a triangle, as one of the lights sees it.
inline Queries queries_of(const std::vector<Corners>& triangles, int lights, int blocks, uint32_t seed) {
  RandomNumbers random(seed);
  Queries q;
  const auto any_triangle = [&]() -> const Corners& {
    return triangles[random.below(int(triangles.size()))];
  };
  for (int i = 0; i < lights; ++i) {
    const Corners& c = any_triangle();
    const glm::dvec3 a(c[0]), u = glm::dvec3(c[1]) - a, v = glm::dvec3(c[2]) - a;
    if (i % 8 == 7) {
      glm::dvec3 axis(0);
      axis[random.below(3)] = random.below(2) ? 1 : -1;
      q.lights.push_back({axis, 0});
    } else if (i % 4 == 3) {
      q.lights.push_back({random.direction(), 0});
    } else if (i % 8 == 0) {  // in a triangle's plane
      q.lights.push_back({a + u * random.between(-2, 2) + v * random.between(-2, 2), 1});
    } else if (i % 8 == 1) {  // at a corner
      q.lights.push_back({a, 1});
    } else {
      q.lights.push_back({random.in_cube(i % 8 == 2 ? 20 : 2), 1});
    }
  }
  for (int i = 0; i < blocks * 16; ++i) {
    const int number = random.below(int(triangles.size()));
    RayPoint p{.gap = 1e-3f};
    p.position =
        i % 4 == 3 ? glm::vec3(random.in_cube(2.5)) : glm::vec3(on_triangle(random, triangles[number]));
    p.own = i % 4 == 3 ? -1 : number;
    q.points.push_back(p);
  }
  for (int block = 0; block < blocks; ++block) {
    for (int light = 0; light < lights; ++light)
      q.packets.push_back(
          {uint32_t(block), uint32_t(light), uint32_t(random.below(4) ? 0xffff : random.below(65536))});
  }
  return q;
}

}  // namespace lightgrid
