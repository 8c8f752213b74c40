// Hard cases of positions of lights: far from each other, parked far away, in worlds of any scale.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "verify/depth_images.h"

namespace lightgrid::verify {
namespace {

// A wall about 3 units away, and lights that just reach one of its pixels.
DepthImage wall(const CullView& view, double unit) {
  return depth_of(view, [&](int x, int y) { return unit * (3 + 0.02 * x + 0.01 * y); });
}

// More lights are far away than near, so that their median is far as well.
void spread_out(Check& c) {
  for (const double far : {1e3, 1e4, 1e5, 1e6, 1e7, 1e9}) {
    const CullView view = placed(sixty_degrees(), {3, -2, 5}, 0.4, -0.2);
    const DepthImage depth = wall(view, 1);
    Random random(36);
    std::vector<CullLight> lights = grazing_lights(view, depth, 600, true, random);
    move_to_world(view, lights);
    for (int i = 0; i < 700; ++i)
      lights.push_back(
          point(far * glm::dvec3(random.uniform(0.9f, 1.1f), 0.7, -0.3 - 0.1 * random.uniform()), 1));
    c.pixels(view, lights, depth, c.every_test());
  }
}

// Lights that are switched off by moving them far away.
void parked(Check& c) {
  constexpr double most_float = std::numeric_limits<float>::max(), most = std::numeric_limits<double>::max();
  const glm::dvec3 positions[] = {{1e19, 0, 0},
                                  {0, -1e30, 0},
                                  {most_float, 0, 0},
                                  {0, 0, -1e19},
                                  {most_float, most_float, most_float},
                                  {most, 0, 0},
                                  {most, -most, most}};
  const DepthImage depth = wall(sixty_degrees(), 1);
  for (const glm::dvec3& position : positions) {
    for (const size_t count : {1, 2, 300}) {
      Random random(37);
      std::vector<CullLight> lights =
          grazing_lights(sixty_degrees(), depth, count == 300 ? 100 : 1, false, random);
      lights.push_back(point({0, 0, -2}, 4));
      const size_t near = lights.size();
      lights.insert(lights.end(), count, point(position, 1));
      const HostGrid grid = c.pixels(sixty_degrees(), lights, depth, {CullerOptions{}});
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
  c.pixels(view, lights, depth, c.every_test());
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

std::vector<HardCase> light_place_cases() {
  const char* group = "lights";
  return {
      CASE(spread_out, "points and spots that just reach a wall at 3 m, and as many lights 10³ … 10⁹ m away",
           "positions rounded relative to the lights' median; cones without slack for that", "nothing lost"),
      CASE(parked, "1, 2 and 300 lights at 10¹⁹, 10³⁰, 3.4·10³⁸ and 1.8·10³⁰⁸ m",
           "the others are far from the median, and dropped", "nothing lost; parked lights are in no list"),
      CASE(worlds_of_any_scale, "lights that just reach surfaces, in units of 10⁻¹⁴ … 10¹³ m",
           "absolute epsilons; finite numbers treated as infinite", "nothing lost"),
      CASE(outside_of_the_domain, "units of 10⁻²² … 10⁻¹⁹ and 10¹⁶, 10¹⁷ m",
           "squares that underflow, 10¹⁸ m treated as infinite", "an input error, or nothing lost"),
  };
}

}  // namespace lightgrid::verify
