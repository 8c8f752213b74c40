// Hard cases of lights: spheres and cones at the edge of what numbers hold, or of a cell; lights far from
// each other, parked far away, and in worlds of any scale.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "scene/view_lights.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

constexpr double inf = no_end, nan = std::numeric_limits<double>::quiet_NaN();

void tangent(Check& c, Contact contact, int ulps) {
  for (const NamedView& named : hard_views(127, 73)) {
    c.grid(named.view, tangent_over_tiles(named.view, 400, contact, 31, ulps));
  }
}
void tangent_to_faces(Check& c) { tangent(c, Contact::face, 0); }
void tangent_to_edges(Check& c) { tangent(c, Contact::edge, 0); }
void tangent_to_corners(Check& c) { tangent(c, Contact::corner, 0); }
void an_ulp_off_tangent(Check& c) { tangent(c, Contact::any, 1); }
void some_ulps_off_tangent(Check& c) { tangent(c, Contact::any, 5); }

void adversarial(Check& c) {
  constexpr size_t batch = 4096;
  const auto views = hard_views(127, 73);
  uint64_t made = 0;
  for (uint64_t round = 0; made < c.adversarial_lights; ++round) {
    const CullView& view = views[round % views.size()].view;
    Random random(Random::mix(round));
    const auto bounds = scattered_bounds(view, 16, random);
    const size_t count = std::min<uint64_t>(batch, c.adversarial_lights - made);
    auto lights = tangent_lights(view, bounds, 16, count - count / 8, Contact::any, 2, random);
    add(lights, tangent_spots(view, bounds, 16, count / 8, random));
    move_to_world(view, lights);
    c.grid(view, lights, bounds);
    made += count;
  }
}

// Spheres of 10^3 to 10^9 m that just reach a cell of centimetres.
void huge_and_tangent(Check& c) {
  Random random(32);
  for (const double size : {1e3, 1e6, 1e9}) {
    std::vector<CullLight> lights;
    const std::vector<DepthInterval> bounds(tile_count(sixty(), 16), {3, 3.01f});
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 centre =
          size * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Cell cell = cell_of(sixty(), 16, random.next() % bounds.size(), bounds[0], true);
      lights.push_back(point(centre, std::nextafter(float(distance_to_cell(cell, centre)), 1e30f)));
    }
    c.grid(sixty(), lights, bounds);
  }
}

void tiny_and_far(Check& c) {
  std::vector<CullLight> lights;
  for (const double d : {10.0, 1e4, 1e7})
    for (int i = 0; i < 60; ++i)
      lights.push_back(point({(i % 10 - 4.5) * 0.1 * d, (i / 10 - 2.5) * 0.1 * d, -d}, 1e-3));
  for (const float d : {10.0f, 1e4f, 1e7f}) c.grid(sixty(), lights, {{d, d}});
}

void radius_of(Check& c, std::initializer_list<double> radii, bool everywhere) {
  std::vector<CullLight> lights;
  for (const double r : radii)
    for (const glm::dvec3 p :
         {glm::dvec3(0, 0, -5), glm::dvec3(0.3, -0.2, -5), glm::dvec3(0), glm::dvec3(0, 0, 7)})
      lights.push_back(point(p, r));
  for (const DepthInterval b : {DepthInterval{5, 5}, DepthInterval{1, 10}, every_distance}) {
    const HostGrid grid = c.grid(sixty(), lights, {b});
    if (everywhere) c.each_cell_lists(grid, uint32_t(lights.size()), "lights of infinite range");
  }
}
void radius_zero(Check& c) { radius_of(c, {0.0, -0.0}, false); }
void radius_denormal(Check& c) { radius_of(c, {1e-40, 1e-45, 1e-300}, false); }
void radius_1e20(Check& c) { radius_of(c, {1e20, 3e38, 1e300}, true); }
void radius_infinite(Check& c) { radius_of(c, {inf}, true); }

// They must not be listed, and must not affect the lights in the same vector of lanes.
void lists_nothing(Check& c, const std::vector<CullLight>& invalid) {
  std::vector<CullLight> lights;
  for (const CullLight& light : invalid) {
    lights.push_back(point({0, 0, -5}, 3));
    lights.push_back(light);
  }
  lights.push_back(point({0, 0, -5}, 3));
  for (const DepthInterval b : {DepthInterval{4, 6}, every_distance}) {
    const HostGrid grid = c.grid(sixty(), lights, {b});
    for (const uint32_t light : grid.indices) c.that(light % 2 == 0, "the invalid light {} is listed", light);
    for (size_t i = 0; i < grid.cells.size(); ++i)
      c.that(grid.cells[i].y == 0 || grid.cells[i].y == invalid.size() + 1,
             "tile {} lists {} of {} equal lights", i, grid.cells[i].y, invalid.size() + 1);
  }
}
void radius_negative(Check& c) {
  lists_nothing(c, {point({0, 0, -5}, -1), point({0, 0, -5}, -1e-45), point({0, 0, -5}, -inf)});
}
void radius_nan(Check& c) { lists_nothing(c, {point({0, 0, -5}, nan), point({0, 0, -5}, -nan)}); }
void position_nan(Check& c) {
  lists_nothing(c, {point({nan, 0, -5}, 1), point({0, nan, -5}, 1e20), point({0, 0, nan}, inf),
                    point({nan, nan, nan}, 1)});
}
void position_infinite(Check& c) {
  lists_nothing(c, {point({inf, 0, -5}, 1), point({0, -inf, -5}, 1e20), point({0, 0, -inf}, 1)});
}

void position_out_of_range(Check& c) {
  std::vector<CullLight> lights = {point({1e300, 0, -5}, 1), point({0, 0, -1e40}, 1),
                                   point({3e18, 0, -1e18}, inf)};
  for (int i = 0; i < 20; ++i) lights.push_back(point({0.1 * i - 1, 0, -5}, 0.3));
  c.grid(sixty(), lights, {{4, 6}});
}

void thousand_coincident(Check& c) {
  const HostGrid one = c.grid(sixty(), {point({0.2, 0.1, -5}, 1)}, {{4, 6}});
  const HostGrid all = c.grid(sixty(), std::vector<CullLight>(1000, point({0.2, 0.1, -5}, 1)), {{4, 6}});
  for (size_t i = 0; i < one.cells.size(); ++i)
    c.that(all.cells[i].y == 1000 * one.cells[i].y, "tile {} lists {} of 1000 lights in one place", i,
           all.cells[i].y);
}

void at_the_eye(Check& c) {
  std::vector<CullLight> lights;
  for (const double r : {0.0, 0.05, 0.1, 0.5, 10.0}) {
    lights.push_back(point({0, 0, 0}, r));
    for (const double angle : {1.0, 45.0, 90.0, 120.0})
      lights.push_back(spot({0, 0, 0}, {0.1, 0.2, -1}, r, angle));
  }
  for (const DepthInterval b : {DepthInterval{0.1f, 0.1f}, DepthInterval{0.1f, 9}, every_distance})
    c.grid(sixty(), lights, {b});
}

void at_the_surface(Check& c) {
  DepthImage depth;
  std::vector<CullLight> lights;
  for (int y = 0; y < 73; ++y) {
    for (int x = 0; x < 127; ++x) {
      const double d = 2 + (x * 7 + y * 3) % 40;
      depth.values.push_back(float(depth_at(sixty(), d)));
      if ((x + 127 * y) % 23) continue;
      const double slope = std::tan(3.14159265358979323846 / 6) * 2 / 73,
                   true_d = distance_at(sixty(), depth.values.back());
      lights.push_back(
          point({(x + 0.5 - 63.5) * slope * true_d, (y + 0.5 - 36.5) * slope * true_d, -true_d}, 1e-5 * d));
    }
  }
  c.pixels(sixty(), lights, depth, every_test());
}

// Spots with the same half-angle, scattered and tangent, also along and against the view direction.
void cones_of(Check& c, std::initializer_list<double> degrees) {
  for (const NamedView& named : hard_views(63, 41)) {
    Random random(33);
    const auto bounds = scattered_bounds(named.view, 16, random);
    std::vector<CullLight> lights;
    for (const double angle : degrees) {
      for (const CullLight& light : scattered_lights(named.view, 120, false, random)) {
        const glm::dvec3 any(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3);
        const glm::dvec3 axes[] = {any, {0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, -light.position - 1e-9};
        lights.push_back(spot(light.position, axes[random.next() % 6], 3 * light.radius_m, angle));
      }
    }
    move_to_world(named.view, lights);
    c.grid(named.view, lights, bounds);
  }
}
void cone_of_zero(Check& c) { cones_of(c, {0}); }
void cone_of_a_tenth(Check& c) { cones_of(c, {0.001, 0.1, 0.5}); }
void cone_just_below_90(Check& c) { cones_of(c, {89.9, 89.99999}); }
void cone_of_90(Check& c) { cones_of(c, {90, 90.00001}); }
void cone_of_100(Check& c) { cones_of(c, {95, 100}); }
void cone_of_120(Check& c) { cones_of(c, {120}); }
void cone_of_180(Check& c) { cones_of(c, {179, 180}); }

glm::dvec3 any_unit(Random& random) {
  return glm::normalize(
      glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3));
}

// Half-angles that floats hold, the one next to 90 degrees among them, whose edge passes a pixel's position.
void edges_at_pixels(Check& c) {
  Random random(36);
  DepthImage depth;
  std::vector<CullLight> lights;
  const double slope = std::tan(std::numbers::pi / 6) * 2 / 73;
  for (int y = 0; y < 73; ++y) {
    for (int x = 0; x < 127; ++x) {
      depth.values.push_back(float(depth_at(sixty(), 2 + (x * 7 + y * 3) % 40)));
      if ((x + 127 * y) % 23) continue;
      const double d = distance_at(sixty(), depth.values.back());
      const glm::dvec3 to_pixel = any_unit(random),
                       beside = glm::normalize(glm::cross(to_pixel, any_unit(random)));
      const float angle = lights.size() % 2 ? std::numbers::pi_v<float> / 2 : random.uniform(0.01f, 1.5f);
      const double reach = random.uniform(0.1f, 3), inside = std::acos(cone_cosine(angle)) - 1e-7;
      lights.push_back(
          {glm::dvec3((x + 0.5 - 63.5) * slope, (y + 0.5 - 36.5) * slope, -1) * d - reach * to_pixel,
           1.01 * reach, std::cos(inside) * to_pixel + std::sin(inside) * beside, cone_cosine(angle)});
    }
  }
  c.pixels(sixty(), lights, depth, every_test());
}

void tangent_cones(Check& c) {
  for (const NamedView& named : hard_views(127, 73)) {
    Random random(34);
    const auto bounds = scattered_bounds(named.view, 16, random);
    auto lights = tangent_spots(named.view, bounds, 16, 500, random);
    move_to_world(named.view, lights);
    c.grid(named.view, lights, bounds);
  }
}

void endless_cones(Check& c) {
  std::vector<CullLight> lights;
  for (const double r : {1e20, inf})
    for (const double angle : {0.1, 20.0, 89.9, 90.0, 150.0})
      for (const glm::dvec3 axis : {glm::dvec3(0.3, 0.1, -1), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)})
        lights.push_back(spot({1, 0.5, -20}, axis, r, angle));
  for (const DepthInterval b : {DepthInterval{4, 6}, DepthInterval{10, 1e18f}, every_distance})
    c.grid(sixty(), lights, {b});
}

void apex_behind_the_cell(Check& c) {
  std::vector<CullLight> lights;
  for (const double angle : {0.5, 5.0, 45.0, 90.0, 110.0, 170.0})
    for (int i = 0; i < 12; ++i)
      for (const double z : {-30.0, -7.0, -6.0001, 2.0})
        lights.push_back(
            spot({(i % 4 - 1.5) * 2, (i / 4 - 1) * 2, z}, {0.05 * i, 0.02, i % 2 ? 1 : -1}, 25, angle));
  c.grid(sixty(), lights, {{5, 6}});
}

// The cone's axis through the exact centre of each cell's box, or of its middle distance.
void axis_through_the_centre(Check& c) {
  std::vector<CullLight> lights;
  for (size_t i = 0; i < tile_count(sixty(), 16); ++i) {
    const Cell cell = cell_of(sixty(), 16, i, {4, 6}, true);
    const double bx = (std::min(cell.x0 * 4, cell.x0 * 6) + std::max(cell.x1 * 4, cell.x1 * 6)) / 2;
    const double by = (std::min(cell.y0 * 4, cell.y0 * 6) + std::max(cell.y1 * 4, cell.y1 * 6)) / 2;
    const glm::dvec3 centre(bx, by, -5);
    for (const glm::dvec3 apex : {glm::dvec3(0), glm::dvec3(0, 3, -5), glm::dvec3(2, 1, -9), centre + 1e-7})
      for (const double angle : {0.0, 0.1, 30.0, 90.0})
        lights.push_back(spot(apex, centre - apex, 20, angle));
    lights.push_back(spot(centre, {0, 0, -1}, 20, 30));
  }
  c.grid(sixty(), lights, {{4, 6}});
}

// Unit up to a float's rounding, or a loader's that reads a few digits.
void direction_almost_unit(Check& c) {
  Random random(35);
  const auto bounds = scattered_bounds(sixty(), 16, random);
  auto lights = tangent_spots(sixty(), bounds, 16, 500, random);
  for (size_t i = 0; i < lights.size(); ++i)
    lights[i].direction = i % 2 ? glm::dvec3(glm::vec3(lights[i].direction))
                                : lights[i].direction * (i % 4 ? 1 + 1e-7 : 1 - 1e-7);
  c.grid(sixty(), lights, bounds);
}

void direction_zero(Check& c) {
  std::vector<CullLight> lights;
  for (const glm::dvec3 axis : {glm::dvec3(0), glm::dvec3(nan, 0, 0), glm::dvec3(1e-300, 0, 0)}) {
    lights.push_back({{0, 0, -5}, 2, axis, 0.5});
    lights.push_back(point({0, 0, -5}, 2));
  }
  const HostGrid grid = c.grid_of_known_answer(sixty(), lights, {{4, 6}}, {});
  c.that(grid.cells.size() == tile_count(sixty(), 16), "no grid");
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const auto list = list_of(grid, i);
    const auto points = std::count_if(list.begin(), list.end(), [](uint32_t light) { return light % 2; });
    c.that(points == 0 || points == 3, "tile {}: a cone without direction disturbs the lights beside it", i);
  }
}

void cosine_out_of_range(Check& c) {
  std::vector<CullLight> lights;
  for (const double cosine : {1.0000001, 1.5, 2.0, -1.0000001, -5.0}) {
    lights.push_back({{0, 0, -1}, 9, {0, 0, -1}, cosine});
    lights.push_back(point({0, 0, -5}, 2));
  }
  const HostGrid grid = c.grid_of_known_answer(sixty(), lights, {{4, 6}}, {});
  c.that(grid.cells.size() == tile_count(sixty(), 16), "no grid");
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const auto list = list_of(grid, i);
    for (const uint32_t wide : {6u, 8u})  // wider than everything: as the sphere
      c.that(std::binary_search(list.begin(), list.end(), wide), "tile {}: a cone past 180 degrees is lost",
             i);
  }
}

// A wall about 3 units away, and lights that just reach one of its pixels.
DepthImage wall(const CullView& view, double unit) {
  return depth_of(view, [&](int x, int y) { return unit * (3 + 0.02 * x + 0.01 * y); });
}

// More lights are far away than near, so that their median is far as well.
void spread_out(Check& c) {
  for (const double far : {1e3, 1e4, 1e5, 1e6, 1e7, 1e9}) {
    const CullView view = placed(small_sixty(), {3, -2, 5}, 0.4, -0.2);
    const DepthImage depth = wall(view, 1);
    Random random(36);
    std::vector<CullLight> lights = grazing_lights(view, depth, 600, true, random);
    move_to_world(view, lights);
    for (int i = 0; i < 700; ++i)
      lights.push_back(
          point(far * glm::dvec3(random.uniform(0.9f, 1.1f), 0.7, -0.3 - 0.1 * random.uniform()), 1));
    c.pixels(view, lights, depth, every_test());
  }
}

// Lights that are switched off by moving them far away.
void parked(Check& c) {
  constexpr double max_float = std::numeric_limits<float>::max(), most = std::numeric_limits<double>::max();
  const glm::dvec3 positions[] = {
      {1e19, 0, 0}, {0, -1e30, 0},      {max_float, 0, 0}, {0, 0, -1e19}, {max_float, max_float, max_float},
      {most, 0, 0}, {most, -most, most}};
  const DepthImage depth = wall(small_sixty(), 1);
  for (const glm::dvec3& position : positions) {
    for (const size_t count : {1, 2, 300}) {
      Random random(37);
      std::vector<CullLight> lights =
          grazing_lights(small_sixty(), depth, count == 300 ? 100 : 1, false, random);
      lights.push_back(point({0, 0, -2}, 4));
      const size_t near = lights.size();
      lights.insert(lights.end(), count, point(position, 1));
      const HostGrid grid = c.pixels(small_sixty(), lights, depth, {CullerOptions{}});
      c.that(std::ranges::none_of(grid.indices, [&](uint32_t light) { return light >= near; }),
             "{} lights parked at {} {} {} are listed", count, position.x, position.y, position.z);
    }
  }
}

void at_scale(Check& c, double unit) {
  CullView view = view_through({.half_x = 0.8, .half_y = 0.6, .near = 0.1 * unit}, 64, 48);
  const DepthImage depth =
      depth_of(view, [&](int x, int y) { return unit * std::exp2((x * 3 + y * 5) % 16 / 4.0); });
  Random random(38);
  const std::vector<CullLight> lights = grazing_lights(view, depth, 400, true, random);
  c.pixels(view, lights, depth, every_test());
  for (int i = 1; i < 16; ++i) view.slice_edges.push_back(float(unit * std::exp2(i / 4.0)));
  c.pixels(view, lights, depth, {CullerOptions{}});
}

void worlds_of_any_scale(Check& c) {
  for (const double unit : {1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9, 1e12, 1e13}) at_scale(c, unit);
}

// Outside the domain: an error, or a correct result.
void outside_of_the_domain(Check& c) {
  for (const double unit : {1e-22, 1e-21, 1e-20, 1e-19, 1e16, 1e17}) {
    try {
      at_scale(c, unit);
    } catch (const Error& error) {
      c.that(error.kind() == ErrorKind::input, "a unit of {} m: {}", unit, error.what());
    }
  }
}

}  // namespace

std::vector<CaseRun> light_cases() {
  return CASES(tangent_to_faces, tangent_to_edges, tangent_to_corners, an_ulp_off_tangent,
               some_ulps_off_tangent, adversarial, huge_and_tangent, tiny_and_far, radius_zero,
               radius_negative, radius_denormal, radius_1e20, radius_infinite, radius_nan, position_nan,
               position_infinite, position_out_of_range, thousand_coincident, at_the_eye, at_the_surface,
               cone_of_zero, cone_of_a_tenth, cone_just_below_90, cone_of_90, cone_of_100, cone_of_120,
               cone_of_180, edges_at_pixels, tangent_cones, endless_cones, apex_behind_the_cell,
               axis_through_the_centre, direction_almost_unit, direction_zero, cosine_out_of_range,
               spread_out, parked, worlds_of_any_scale, outside_of_the_domain);
}

}  // namespace lightgrid::lab::verify
