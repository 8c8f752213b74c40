// Hard cases of lights: spheres and cones at the edge of what numbers hold, or of a cell.
#include <algorithm>
#include <cmath>

#include "verify/check.h"
#include "verify/tangent_lights.h"

namespace lightgrid::verify {
namespace {

constexpr double inf = no_end, nan = std::numeric_limits<double>::quiet_NaN();

void tangent(Check& c, Contact contact, int ulps) {
  for (const NamedView& named : hard_views(127, 73)) {
    const auto [bounds, lights] = tangent_over_tiles(named.view, 400, contact, 31, ulps);
    c.grid(named.view, lights, bounds);
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
    const auto spots = tangent_spots(view, bounds, 16, count / 8, random);
    lights.insert(lights.end(), spots.begin(), spots.end());
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
    for (size_t i = 0; i < grid.cells.size() && everywhere; ++i)
      c.that(grid.cells[i].y == lights.size(), "tile {} lists {} of {} lights of infinite range", i,
             grid.cells[i].y, lights.size());
  }
}

void radius_zero(Check& c) { radius_of(c, {0.0, -0.0}, false); }
void radius_denormal(Check& c) { radius_of(c, {1e-40, 1e-45, 1e-300}, false); }
void radius_1e20(Check& c) { radius_of(c, {1e20, 3e38, 1e300}, true); }
void radius_infinite(Check& c) { radius_of(c, {inf}, true); }

// They must not be listed, and must not affect the lights in the same vector of lanes.
void lists_nothing(Check& c, const std::vector<CullLight>& invalid) {
  std::vector<CullLight> lights;
  for (const CullLight& light : invalid) lights.push_back(point({0, 0, -5}, 3)), lights.push_back(light);
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
  c.pixels(sixty(), lights, depth, c.every_test());
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
  for (const double cosine : {1.0000001, 1.5, 2.0, -1.0000001, -5.0})
    lights.push_back({{0, 0, -1}, 9, {0, 0, -1}, cosine}), lights.push_back(point({0, 0, -5}, 2));
  const HostGrid grid = c.grid_of_known_answer(sixty(), lights, {{4, 6}}, {});
  c.that(grid.cells.size() == tile_count(sixty(), 16), "no grid");
  for (size_t i = 0; i < grid.cells.size(); ++i) {
    const auto list = list_of(grid, i);
    for (const uint32_t wide : {6u, 8u})  // wider than everything: as the sphere
      c.that(std::binary_search(list.begin(), list.end(), wide), "tile {}: a cone past 180 degrees is lost",
             i);
  }
}

}  // namespace

std::vector<HardCase> light_cases() {
  const char* group = "lights";
  return {
      CASE(tangent_to_faces, "spheres that end exactly on a cell's face, in eight kinds of view",
           "0.2 to 12 % lost without slack", "listed"),
      CASE(tangent_to_edges, "on an edge", "lost without slack", "listed"),
      CASE(tangent_to_corners, "on a corner", "lost without slack", "listed"),
      CASE(an_ulp_off_tangent, "radius one ulp more or less", "r² rounds across the distance",
           "listed if it touches"),
      CASE(some_ulps_off_tangent, "up to five ulps", "the same", "listed if it touches"),
      CASE(adversarial, "10⁵ tangent lights and cones in random cells (10⁷ with --nightly)",
           "unforeseen faults", "0 lost"),
      CASE(huge_and_tangent, "radii of 10³, 10⁶, 10⁹ m that reach a cell by an ulp",
           "the cell's size is lost in the sum", "listed"),
      CASE(tiny_and_far, "radius 1 mm at 10, 10⁴, 10⁷ m", "radius below a step of the distance",
           "listed at its position"),
      CASE(radius_zero, "r = 0, -0", "0/0", "no NaN; listed at most at its position"),
      CASE(radius_negative, "-1, -1e-45, -∞", "r² makes it positive", "listed nowhere"),
      CASE(radius_denormal, "1e-40, 1e-45, 1e-300", "flushed, or 1/r infinite", "as radius 0"),
      CASE(radius_1e20, "1e20, 3e38, 1e300", "r² overflows", "listed everywhere"),
      CASE(radius_infinite, "∞", "inf - inf", "listed everywhere"),
      CASE(radius_nan, "NaN", "the form of each comparison decides", "listed nowhere"),
      CASE(position_nan, "NaN in any coordinate", "poisons a vector of lanes",
           "listed nowhere, neighbours unharmed"),
      CASE(position_infinite, "±∞ in any coordinate", "inf - inf", "listed nowhere, neighbours unharmed"),
      CASE(position_out_of_range, "10⁴⁰, 10³⁰⁰ m", "infinite as float", "no crash, neighbours unharmed"),
      CASE(thousand_coincident, "1000 lights in one place", "a full list drops some",
           "all or none of them in each tile"),
      CASE(at_the_eye, "lights and cones at the origin", "normalize(0)", "nothing lost"),
      CASE(at_the_surface, "lights of 10⁻⁵ d at shaded points", "bounds rounded past the surface",
           "listed for that pixel"),
      CASE(cone_of_zero, "half-angle 0°", "tan 0: an empty hull (PlayCanvas #4864)", "nothing lost"),
      CASE(cone_of_a_tenth, "0.001°, 0.1°, 0.5°", "the cosine rounds to 1", "nothing lost"),
      CASE(cone_just_below_90, "89.9°, 89.99999°", "the tangent is huge", "nothing lost"),
      CASE(cone_of_90, "90°, 90.00001°", "tan(float π/2) = -2.3·10⁷ (Bevy #25368)", "nothing lost"),
      CASE(cone_of_100, "95°, 100°", "a cone-sphere test loses 12 % of cells", "nothing lost"),
      CASE(cone_of_120, "120°", "28 % (Godot #48054)", "nothing lost"),
      CASE(cone_of_180, "179°, 180°", "41 %", "nothing lost"),
      CASE(tangent_cones, "cones whose side touches a cell", "rounding of the axis", "listed"),
      CASE(endless_cones, "cones of radius 1e20, ∞", "0 · inf", "nothing lost"),
      CASE(apex_behind_the_cell, "apexes in front of, beside and behind cells",
           "the sign of the distance along the axis", "nothing lost"),
      CASE(axis_through_the_centre, "the axis through the cell's centre; the apex on it",
           "√(-tiny), normalize(0)", "listed"),
      CASE(direction_almost_unit, "lengths that differ from 1 by 10⁻⁷", "across and along scaled differently",
           "nothing lost"),
      CASE(direction_zero, "directions 0, NaN, 10⁻³⁰⁰", "NaN in the lanes", "no crash, neighbours unharmed"),
      CASE(cosine_out_of_range, "cosines above 1 and below -1", "√ of a negative number",
           "no crash; below -1 the sphere"),
  };
}

}  // namespace lightgrid::verify
