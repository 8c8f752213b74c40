#include "verify/inputs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/position.h"

namespace lightgrid::lab::verify {
namespace {

using std::numbers::pi;

// A point on the cell: at an end of `ends` of its three extents, anywhere between in the others.
glm::dvec3 contact_point(const Cell& cell, Contact contact, Random& random) {
  const double far = std::min(cell.far, 100 * std::max(std::abs(cell.near), 0.1));
  const double near = std::max(cell.near, -far);
  int at_end = contact == Contact::any    ? 1 + int(random.next() % 3)
               : contact == Contact::face ? 1
               : contact == Contact::edge ? 2
                                          : 3;
  bool ends[3] = {};
  for (; at_end > 0; --at_end) {
    int axis = int(random.next() % 3);
    while (ends[axis]) axis = (axis + 1) % 3;
    ends[axis] = true;
  }
  const auto pick = [&](bool end, double low, double high) {
    const float t = random.uniform();
    return end ? (t < 0.5f ? low : high) : low + (high - low) * t;
  };
  const double d = pick(ends[2], near, far), scale = cell.scale_at(d);
  return {pick(ends[0], cell.x0, cell.x1) * scale, pick(ends[1], cell.y0, cell.y1) * scale, -d};
}

float stepped(float value, int steps) {
  for (; steps > 0; --steps) value = std::nextafter(value, float(no_end));
  for (; steps < 0; ++steps) value = std::nextafter(value, 0.0f);
  return value;
}

// A spot whose axis is turned by `off` from the direction opposite to `away`, towards any side.
CullLight spot_past(const glm::dvec3& apex, double radius, const glm::dvec3& away, double off,
                    double cos_outer, Random& random) {
  const glm::dvec3 side = glm::normalize(glm::cross(away, any_direction(random)) + 1e-9);
  const glm::dvec3 across = glm::normalize(side - away * glm::dot(side, away));
  return {apex, radius, glm::normalize(-away * std::cos(off) + across * std::sin(off)),
          std::max(0.0, cos_outer)};
}

size_t some_cell(std::span<const DepthInterval> bounds, Random& random) {
  for (;;) {
    const size_t i = random.next() % bounds.size();
    if (bounds[i].near <= bounds[i].far) return i;
  }
}

}  // namespace

OverDepth scattered_over_depth(const CullView& view, size_t count, bool spots, uint64_t seed) {
  Random random(seed);
  OverDepth over{scattered_depth(view, random), {}};
  over.lights = scattered_lights(view, count, spots, random);
  move_to_world(view, over.lights);
  return over;
}

OverTiles scattered_over_tiles(const CullView& view, size_t count, bool spots, uint64_t seed) {
  Random random(seed);
  OverTiles over{scattered_bounds(view, 16, random), {}};
  over.lights = scattered_lights(view, count, spots, random);
  move_to_world(view, over.lights);
  return over;
}

OverTiles tangent_over_tiles(const CullView& view, size_t count, Contact contact, uint64_t seed, int ulps) {
  Random random(seed);
  OverTiles over{scattered_bounds(view, 16, random), {}};
  over.lights = tangent_lights(view, over.bounds, 16, count, contact, ulps, random);
  move_to_world(view, over.lights);
  return over;
}

void add(std::vector<CullLight>& lights, const std::vector<CullLight>& more) {
  lights.insert(lights.end(), more.begin(), more.end());
}

CullLight point(const glm::dvec3& position, double radius) {
  return {.position = position, .radius_m = radius};
}

CullLight spot(const glm::dvec3& position, const glm::dvec3& direction, double radius, double outer_deg) {
  return {position, radius, glm::normalize(direction), std::cos(outer_deg * pi / 180)};
}

std::vector<CullLight> tangent_lights(const CullView& view, std::span<const DepthInterval> bounds, int tile,
                                      size_t count, Contact contact, int ulps, Random& random) {
  std::vector<CullLight> lights;
  while (lights.size() < count) {
    const size_t i = some_cell(bounds, random);
    const Cell cell = cell_of(view, tile, i, bounds[i], true);
    const glm::dvec3 q = contact_point(cell, contact, random);
    // Sizes range from a hundredth of the cell's width to far larger than the cell.
    const double width = std::max((cell.x1 - cell.x0) * cell.scale_at(-q.z), 1e-6 * std::abs(q.z));
    const double size = width * std::exp2(16 * random.uniform() - 7);
    const glm::dvec3 centre = q + size * any_direction(random);
    const double distance = distance_to_cell(cell, centre);
    if (!(distance > 1e-30)) continue;
    float radius = float(distance);
    if (radius < distance) radius = std::nextafter(radius, float(no_end));
    lights.push_back(point(centre, stepped(radius, ulps ? int(random.next() % (2 * ulps + 1)) - ulps : 0)));
  }
  return lights;
}

std::vector<CullLight> tangent_spots(const CullView& view, std::span<const DepthInterval> bounds, int tile,
                                     size_t count, Random& random) {
  std::vector<CullLight> lights;
  while (lights.size() < count) {
    const size_t i = some_cell(bounds, random);
    const Cell cell = cell_of(view, tile, i, bounds[i], true);
    const glm::dvec3 q = contact_point(cell, Contact::any, random);
    const double size = std::max((cell.x1 - cell.x0) * cell.scale_at(-q.z), 1e-6 * std::abs(q.z)) *
                        std::exp2(8 * random.uniform() - 2);
    const glm::dvec3 away = any_direction(random), apex = q + size * away;
    if (!(distance_to_cell(cell, apex) > 0.01 * size)) continue;
    // The axis is turned away from the contact by the half-angle, so that the cone's side passes through it.
    const double angle = std::exp2(-10 * random.uniform()) * pi / 2;
    lights.push_back(spot_past(apex, 4 * size, away, angle, std::cos(angle * (1 + 1e-7)), random));
  }
  return lights;
}

std::optional<glm::dvec3> surface_at(const CullView& view, const DepthImage& depth, int x, int y,
                                     int sample) {
  const size_t at = depth.index(view, x, y, sample);
  const float value = depth.values[at];
  if (!(value >= 0 && value <= 1) || value == depth_of_nothing(view)) return {};
  const View v = oracle_view(view);
  return depth.distances.empty() ? lab::position_from_depth(v, x, y, value)
                                 : position_at(v, x, y, depth.distances[at]);
}

std::vector<CullLight> lights_at_surfaces(const CullView& view, const DepthImage& depth, double share) {
  std::vector<CullLight> lights;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto surface = surface_at(view, depth, x, y);
      if (surface) lights.push_back(point(*surface, share * std::max(-surface->z, 0.01)));
    }
  }
  return lights;
}

std::vector<CullLight> grazing_lights(const CullView& view, const DepthImage& depth, size_t count, bool spots,
                                      Random& random) {
  const auto pick = [&](int size) { return std::clamp(int(double(random.uniform()) * size), 0, size - 1); };
  std::vector<CullLight> lights;
  for (size_t tries = 0; lights.size() < count && tries < 100 * count; ++tries) {
    const int x = pick(view.width), y = pick(view.height);
    const std::optional<glm::dvec3> surface = surface_at(view, depth, x, y);
    if (!surface) continue;
    const glm::dvec3 q = *surface;
    const double size = glm::length(q) * std::exp2(15 * random.uniform() - 12);
    const double hair = 0x1p-24 * std::exp2(-10 * random.uniform());
    const glm::dvec3 away = any_direction(random), place = q + size * away;
    const double distance = glm::length(place - q);
    if (!(distance > 0)) continue;
    if (!spots || lights.size() % 2 == 0) {
      lights.push_back(point(place, distance * (1 + hair)));
      continue;
    }
    // The axis deviates from the direction to the surface by slightly less than the half-angle.
    const double angle = std::exp2(-10 * random.uniform()) * pi / 2, off = angle * (1 - hair);
    lights.push_back(spot_past(place, 4 * distance, away, off, std::cos(angle), random));
  }
  return lights;
}

std::vector<CullLight> scattered_lights(const CullView& view, size_t count, bool spots, Random& random) {
  const View v = oracle_view(view);
  constexpr double angles[] = {0.1, 10, 30, 60, 89.9, 90, 100, 120, 180};
  std::vector<CullLight> lights;
  for (size_t i = 0; i < count; ++i) {
    const double px = v.width * (1.4 * random.uniform() - 0.2),
                 py = v.height * (1.4 * random.uniform() - 0.2);
    const double d = 0.05 * std::exp2(11 * random.uniform()) * (i % 10 == 0 ? -1 : 1);
    const double scale = v.orthographic ? 1 : d;
    const glm::dvec3 p(view_x_of_pixel(v, px) * scale, view_y_of_pixel(v, py) * scale, -d);
    const double image = (view_x_of_pixel(v, v.width) - view_x_of_pixel(v, 0)) * std::abs(scale);
    const float radius = float(image * std::exp2(-9 * random.uniform()));
    if (spots && i % 2)
      lights.push_back(spot(p, any_direction(random), 4 * radius, angles[i / 2 % 9]));
    else
      lights.push_back(point(p, radius));
  }
  return lights;
}

std::vector<DepthInterval> scattered_bounds(const CullView& view, int tile, Random& random) {
  std::vector<DepthInterval> bounds(tile_count(view, tile));
  for (DepthInterval& b : bounds) {
    const float near = 0.1f * std::exp2(9 * random.uniform());
    const DepthInterval kinds[] = {no_surface,          every_distance, {near, near},
                                   {0.1f, near},        {near, 1e18f},  {near, near * (1 + random.uniform())},
                                   {near, near * 1.01f}};
    b = kinds[random.next() % 7];
  }
  return bounds;
}

DepthImage scattered_depth(const CullView& view, Random& random) {
  DepthImage depth;
  depth.values.resize(size_t(view.width) * view.height);
  for (float& value : depth.values) {
    const double distance = 0.3 * std::exp2(8 * random.uniform());
    value = random.uniform() < 0.1f ? depth_of_nothing(view)
                                    : float(std::clamp(depth_at(view, distance), 0.0, 1.0));
  }
  return depth;
}

}  // namespace lightgrid::lab::verify
