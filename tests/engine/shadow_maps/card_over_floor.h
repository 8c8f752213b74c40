// A card over a floor, solved by hand: a light at the height h, above the middle of a square card of half
// side s at the height c, sees the points of the floor outside of a square of half side s h / (h - c). The
// card is turned, so that no edge follows a row of texels. The sun's rays are parallel: its shadow is a
// square of half side s, moved along them.
#pragma once

#include <cmath>

#include "scene/camera.h"
#include "shadow_maps/shadow_maps.h"

namespace lightgrid {

inline constexpr double light_height_m = 3, card_height_m = 1, card_half_m = 0.5;
inline constexpr double card_turn_rad = 0.3;
inline const WorldBox room{{-8, 0, -8}, {8, 4, 8}};
inline constexpr double shadow_half_m = card_half_m * light_height_m / (light_height_m - card_height_m);

inline ClDevice& device() {
  static ClDevice device;
  return device;
}
inline ProgramCache& programs() {
  static ProgramCache programs(device());
  return programs;
}

inline glm::vec2 turned(const glm::vec2& p, double angle_rad) {
  const float c = float(std::cos(angle_rad)), s = float(std::sin(angle_rad));
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

inline RayScene scene_of(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
  RayScene rays(device(), programs(), {.origin = glm::dvec3(0)});
  const RayMesh mesh{positions, indices};
  const RayInstance instance{};
  rays.set_meshes({&mesh, 1});
  rays.set_instances({&instance, 1});
  return rays;
}

// Two triangles each: the floor (numbers 0 and 1), then the card.
inline RayScene card_over_floor() {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (const glm::vec2 quad : {glm::vec2(7.3, 0), glm::vec2(card_half_m, card_height_m)}) {
    const uint32_t first = uint32_t(positions.size());
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
      const glm::vec2 at = turned(corner * quad.x, quad.y > 0 ? card_turn_rad : 0);
      positions.push_back({at.x, quad.y, at.y});
    }
    for (const uint32_t k : {0, 2, 1, 0, 3, 2}) indices.push_back(first + k);
  }
  return scene_of(positions, indices);
}

inline Light lamp(LightType type) {
  Light light;
  light.type = type;
  light.position = {0, light_height_m, 0};
  light.direction = {0, -1, 0};
  light.radius_m = 8;
  light.outer_cone_rad = 1.0f;
  if (is_directional(light)) light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  return light;
}

inline View view_from(double distance_m) {
  return make_view(look_at({0, 0.5, distance_m}, {0, 0, 0}), 640, 480);
}

// Metres from a point of the floor to the shadow's edge, above 0 inside.
inline double inside_m(const Light& light, const glm::vec3& point) {
  const bool sun = is_directional(light);
  const glm::vec3 moved = sun ? point + light.direction * (float(card_height_m) / light.direction.y) : point;
  const glm::vec2 p = turned({moved.x, moved.z}, -card_turn_rad);
  return (sun ? card_half_m : shadow_half_m) - std::max(std::abs(p.x), std::abs(p.y));
}

// Points of the floor, 4.5 m each way in steps of 3 cm: further than 3 m from its middle it is seen by a
// cube's side faces, whose axes it is parallel to.
inline std::vector<RayPoint> floor_points() {
  std::vector<RayPoint> points;
  for (float x = -4.49f; x < 4.5f; x += 0.03f)
    for (float z = -4.49f; z < 4.5f; z += 0.03f)
      points.push_back({.position = {x, 0, z}, .own = x > z ? 0 : 1});
  points.resize(points.size() / 16 * 16);
  return points;
}

inline std::vector<uint8_t> taps_at(ShadowMaps& maps, const RayScene& rays,
                                    const std::vector<RayPoint>& points) {
  std::vector<RayPacket> packets;
  for (uint32_t block = 0; block < points.size() / 16; ++block) packets.push_back({block, 0});
  return maps.look_up(rays, points, packets);
}

inline glm::dvec3 axis(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// Returns whether a cascade has all texels that a point reads.
inline bool holds_taps(const ShadowFace& f, const glm::dvec3& point, int taps) {
  const glm::dvec3 to = point - axis(f.from);
  const double most = double(f.extent) * (int(f.size) - 2 * (taps / 2)) / int(f.size);
  return std::abs(glm::dot(to, axis(f.right))) < most && std::abs(glm::dot(to, axis(f.up))) < most;
}

struct Wrong {
  int leaked = 0, acned = 0;
  double furthest_m = 0;  // from the shadow's edge
};

// taps: of floor_points().
inline Wrong wrong_points(const Light& light, const ShadowMapOptions& options,
                          const std::vector<uint8_t>& taps) {
  const std::vector<RayPoint> points = floor_points();
  const int most = options.taps * options.taps;
  Wrong wrong;
  for (size_t i = 0; i < points.size(); ++i) {
    const double inside = inside_m(light, points[i].position);
    const bool leaked = inside > 0 && taps[i] < most, acned = inside < 0 && taps[i] > 0;
    wrong.leaked += leaked;
    wrong.acned += acned;
    if (leaked || acned) wrong.furthest_m = std::max(wrong.furthest_m, std::abs(inside));
  }
  return wrong;
}

inline Wrong wrong_points(const Light& light, const ShadowMapOptions& options) {
  const RayScene rays = card_over_floor();
  ShadowMaps maps(device(), programs(), options);
  maps.draw(rays, plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options));
  return wrong_points(light, options, taps_at(maps, rays, floor_points()));
}

// The largest error of a texel on the floor, which the light sees from above. A texel's centre is at most
// half a texel away along either side, and each tap of a filter a texel more: no point further from the edge
// may be wrong.
inline double max_wrong_m(const Light& light, const ShadowMapOptions& options) {
  const ShadowAtlas atlas = plan_shadow_atlas({&light, 1}, view_from(5), glm::dvec3(0), room, options);
  const double texel_m = 2 * double(atlas.faces[0].extent) / options.size *
                         (is_directional(light) ? 1 / std::abs(light.direction.y) : light_height_m);
  return (0.5 + options.taps / 2) * std::sqrt(2) * texel_m * 1.001;
}

}  // namespace lightgrid
