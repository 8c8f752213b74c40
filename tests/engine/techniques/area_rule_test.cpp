// The points of area lights, compiled as C++, against adaptive quadrature in double.
#define EFFECT_AREA_LIGHTS
#define TAKEN_INPUT(kind, type, name, resource) , [[maybe_unused]] const type* name
#define PASSED_INPUT(kind, type, name, resource) , name
#define COLUMN(type, name, i) (type((name)[i]))
#include "shared/brdf.h"
namespace lightgrid {
using LightIndex = uint;
}
#include "shared/effects/area_lights.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "oracle/shading.h"
#include "scene/area_lights.h"
#include "scene/light_axes.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// Gauss's rules on 0 to 1, from tables: positions and weights, the first with the number of points.
std::vector<glm::vec4> rule_of(int points) {
  static const std::vector<glm::vec4> rules[] = {
      {{0.5f, 1, 1, 0}},
      {{0.21132487f, 0.5f, 2, 0}, {0.78867513f, 0.5f, 0, 0}},
      {{0.11270167f, 5.0f / 18, 3, 0}, {0.5f, 4.0f / 9, 0, 0}, {0.88729833f, 5.0f / 18, 0, 0}},
      {{0.06943184f, 0.17392742f, 4, 0},
       {0.33000948f, 0.32607258f, 0, 0},
       {0.66999052f, 0.32607258f, 0, 0},
       {0.93056816f, 0.17392742f, 0, 0}}};
  std::vector<glm::vec4> values = rules[points - 1];
  values.resize(AREA_RULE);
  return values;
}

// A light at a place, a surface at the origin of view space that is seen from `to_eye`.
struct Lit {
  Light light;
  dvec3 normal{0, 0, 1}, to_eye{0, 0, 1};
  double roughness = 0.5, metallic = 0;

  Lit& panel(dvec3 at, dvec3 direction, double width, double height, dvec3 up = {0, 1, 0}) {
    light.position = at;
    light.direction = glm::normalize(direction);
    set_rectangle(light, width, height);
    set_up(light, up);
    return *this;
  }
};

dvec3 by_points(const Lit& lit, int points) {
  const LightRectangle r = rectangle_of(lit.light);
  std::vector<glm::vec4> sides = rule_of(points);
  sides.insert(sides.end(), {glm::vec4(r.across, 1), glm::vec4(r.up, 0), glm::vec4(r.direction, 0)});
  const ShadingPoint p = shading_point(glm::vec3(0), glm::vec3(lit.to_eye), glm::vec3(lit.normal),
                                       glm::vec3(0.5f), float(lit.metallic), float(lit.roughness));
  return area_lights_radiance(0, p, glm::vec3(lit.light.position), sides.data());
}

dvec3 in_double(const Lit& lit) {
  Scene scene;
  scene.lights = {lit.light};
  const ViewLight light = lights_in_view(scene, View{.view_from_world = glm::dmat4(1)})[0];
  const Surface surface{
      .normal = lit.normal, .base_color = dvec3(0.5), .metallic = lit.metallic, .roughness = lit.roughness};
  return (*light.lit)(
      -light.position,
      {[&](const dvec3& l) { return lab::reflected(surface, lit.to_eye, l); }, lit.to_eye, {lit.normal}});
}

double relative_error_of(const Lit& lit, int points = 4) {
  const dvec3 is = by_points(lit, points), should = in_double(lit);
  EXPECT_TRUE(std::isfinite(is.x) && is.x >= 0) << is.x;
  return std::abs(is.x - should.x) / std::max(should.x, 1e-30);
}

// A white panel that fills the half-space is a constant environment: a diffuse surface reflects its colour.
TEST(AreaRule, AnEndlessPanelIsAConstantEnvironment) {
  Lit lit;
  lit.panel({0, 0, 1e-3}, {0, 0, -1}, 200, 200).metallic = 0;
  lit.roughness = 1;
  lit.to_eye = {0, 0, 1};
  // The radiance is the intensity over the area.
  const Surface white{.base_color = dvec3(1)};
  Scene scene;
  scene.lights = {lit.light};
  const ViewLight light = lights_in_view(scene, View{.view_from_world = glm::dmat4(1)})[0];
  const dvec3 reflected =
      (*light.lit)(-light.position, {[&](const dvec3& l) {
                                       return lab::reflected(white, {0, 0, 1}, l, Brdf::lambert);
                                     },
                                     {0, 0, 1},
                                     {white.normal}});
  EXPECT_NEAR(reflected.x * 200 * 200, 1, 1e-4);
}

// Solved by hand: the differential form factor of a square opposite, parallel, at its own half-side's distance:
// 4 / (2 pi) (2 x / sqrt(1 + x^2) atan(x / sqrt(1 + x^2))) with x = 1.
TEST(AreaRule, AParallelSquareIsItsFormFactor) {
  Lit lit;
  lit.panel({0, 0, 2}, {0, 0, -1}, 4, 4);
  const Surface white{.base_color = dvec3(1)};
  Scene scene;
  scene.lights = {lit.light};
  const ViewLight light = lights_in_view(scene, View{.view_from_world = glm::dmat4(1)})[0];
  const dvec3 reflected =
      (*light.lit)(-light.position, {[&](const dvec3& l) {
                                       return lab::reflected(white, {0, 0, 1}, l, Brdf::lambert);
                                     },
                                     {0, 0, 1},
                                     {white.normal}});
  const double root = std::sqrt(0.5), factor = 4 / std::numbers::pi * root * std::atan(root);
  EXPECT_NEAR(reflected.x * 16, factor, 1e-8);
}

// Seen from far away, a small rectangle is a point that obeys Lambert's law.
TEST(AreaRule, AFarRectangleIsAPoint) {
  Lit lit;
  lit.panel({3, 0, 40}, {0.1, 0.2, -1}, 0.01, 0.02);
  const dvec3 to_light = lit.light.position;
  const double distance = glm::length(to_light);
  const dvec3 l = to_light / distance;
  const double cosine = -glm::dot(l, dvec3(lit.light.direction));
  const Surface surface{.base_color = dvec3(0.5), .roughness = 0.5};
  const double point = lab::reflected(surface, lit.to_eye, l).x * cosine / (distance * distance);
  EXPECT_NEAR(by_points(lit, 4).x / point, 1, 1e-5);
  EXPECT_NEAR(in_double(lit).x / point, 1, 1e-5);
}

struct AreaCase {
  const char* name;
  Lit lit;
  double largest_error;
};

std::vector<AreaCase> hard_cases() {
  const auto at = [](double metallic, double roughness, dvec3 to_eye) {
    return Lit{.to_eye = glm::normalize(to_eye), .roughness = roughness, .metallic = metallic};
  };
  const Lit plain = at(0, 0.5, {0.3, 0, 1}), metal = at(1, 0.3, {1, 0, 1}), mirror = at(1, 0, {1, 0, 1});
  const auto panel = [](Lit lit, dvec3 place, dvec3 direction, double width, double height,
                        dvec3 up = {0, 1, 0}) { return lit.panel(place, direction, width, height, up); };
  return {
      {"tiny", panel(plain, {0, 0, 2}, {0, 0, -1}, 1e-4, 1e-4), 1e-5},
      {"10 km wide", panel(plain, {0, 0, 1}, {0, 0, -1}, 1e4, 1e4), 2e-3},
      {"a micrometre before it", panel(plain, {0, 0, 1e-6}, {0, 0, -1}, 1, 1), 2e-2},
      {"in its plane, outside", panel(plain, {2, 0, 0}, {0, 0, -1}, 1, 1), 0},
      {"in its plane, inside", panel(plain, {0, 0, 0}, {0, 0, -1}, 1, 1), 0},
      {"behind it", panel(plain, {0, 0, 2}, {0, 0, 1}, 1, 1), 0},
      {"below the horizon", panel(plain, {0, 0, -2}, {0, 0, 1}, 1, 1), 0},
      {"crossing the horizon", panel(plain, {1, 0, 0.2}, {-1, 0, 0}, 1, 1, {0, 0, 1}), 1e-2},
      {"its edge on the horizon", panel(plain, {1, 0, 0.5}, {-1, 0, 0}, 1, 1, {0, 0, 1}), 1e-3},
      {"a sliver above the horizon", panel(plain, {1, 0, -0.499}, {-1, 0, 0}, 1, 1, {0, 0, 1}), 2e-2},
      {"seen edge-on", panel(plain, {1, 0, 1}, {-1, 0, 0.999}, 1, 1), 1e-2},
      {"aspect 1:1000", panel(plain, {0, 0.3, 1}, {0, 0, -1}, 2, 2e-3), 1e-4},
      {"a mirror, at the middle", panel(mirror, {-1, 0, 1}, {1, 0, -1}, 1, 1), 2e-2},
      {"a mirror, at the edge", panel(mirror, {-1, 0.5, 1}, {1, 0, -1}, 1, 1), 5e-2},
      {"a mirrored ray parallel to its plane", panel(metal, {-1, 0, 1.5}, {1, 0, -1.001}, 1, 1), 5e-2},
      {"a grazing view", panel(at(0, 0.5, {1, 0, 0.002}), {-1, 0, 1}, {1, 0, -1}, 1, 1), 5e-2},
      {"roughness 1", panel(at(1, 1, {1, 0, 1}), {-1, 0, 1}, {1, 0, -1}, 1, 1), 1e-4},
      {"ten lobes next to it", panel(at(1, 0.2, {1, 0, 1}), {0, 1.5, 1}, {0, -1.5, -1}, 0.5, 0.5), 1e-3},
      {"up along its direction", panel(plain, {0.2, 0, 2}, {0, 0, -1}, 1, 0.5, {0, 0, 1}), 1e-4},
      {"up of length 0", panel(plain, {0.2, 0, 2}, {0, 0, -1}, 1, 0.5, {0, 0, 0}), 1e-4},
  };
}

TEST(AreaRule, HardCases) {
  for (const AreaCase& each : hard_cases()) {
    SCOPED_TRACE(each.name);
    const dvec3 is = by_points(each.lit, 4);
    const double error = relative_error_of(each.lit);
    fmt::print("{:<40} {:.3e}, error {:.2e}\n", each.name, is.x, error);
    EXPECT_LE(error, each.largest_error);
    if (each.largest_error == 0) {
      EXPECT_EQ(is, dvec3(0));
    }
  }
}

struct Errors {
  double mean = 0, p99 = 0, max = 0;
};

// Random rectangles that face a surface, 60 % of them around the mirrored ray, above the horizon or across it.
Errors errors_of(int points, double roughness, bool crossing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
  };
  std::vector<double> errors;
  while (errors.size() < 400) {
    const double angle = uniform(random) * 1.4, turn = uniform(random) * 6.28;
    Lit lit{.to_eye = {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)},
            .roughness = roughness,
            .metallic = 0.5};
    const dvec3 mirrored = dvec3(-lit.to_eye.x, -lit.to_eye.y, lit.to_eye.z);
    const dvec3 to =
        uniform(random) < 0.6 ? glm::normalize(mirrored + 0.5 * roughness * direction()) : direction();
    const dvec3 emits = glm::normalize(-to + 0.9 * direction());
    const double half = std::exp(std::lerp(std::log(0.03), std::log(2.0), uniform(random)));
    lit.panel(to, emits, 2 * half, 2 * half * (0.15 + 0.85 * uniform(random)), direction());
    if (glm::dot(-to, emits) < 0.15) continue;
    const LightRectangle r = rectangle_of(lit.light);
    const double reach = std::abs(r.across.z) + std::abs(r.up.z);
    if (to.z + reach <= 0 || (to.z - reach < 0) != crossing) continue;
    errors.push_back(relative_error_of(lit, points));
  }
  std::ranges::sort(errors);
  return {std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size()),
          errors[errors.size() * 99 / 100], errors.back()};
}

// The figures of docs/area_lights.md.
TEST(AreaRule, ErrorByPointsAndRoughness) {
  struct Row {
    int points;
    double roughness;
    bool crossing;
    double largest_mean;
  };
  const Row rows[] = {{1, 0.5, false, 0.057}, {2, 0.5, false, 0.0075}, {3, 0.5, false, 0.0023},
                      {4, 0.1, false, 0.009}, {4, 0.3, false, 0.0016}, {4, 0.5, false, 0.0008},
                      {4, 1, false, 0.00045}, {4, 0.1, true, 0.007},   {4, 0.5, true, 0.0125},
                      {4, 1, true, 0.013}};
  for (const Row& row : rows) {
    const Errors errors = errors_of(row.points, row.roughness, row.crossing);
    fmt::print("{} points, roughness {}, {} the horizon: mean {:.1e}, p99 {:.1e}, max {:.1e}\n",
               row.points * row.points, row.roughness, row.crossing ? "across" : "above", errors.mean,
               errors.p99, errors.max);
    EXPECT_LE(errors.mean, row.largest_mean);
  }
}

}  // namespace
}  // namespace lightgrid
