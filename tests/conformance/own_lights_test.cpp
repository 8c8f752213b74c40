// KHR_lights_punctual from a file to the picture: radiances worked out by hand.
#include "conformance/own_model.h"

#include <algorithm>

namespace lightgrid {
using namespace lab;
namespace {

using nlohmann::json;

constexpr double root_half = 0.70710678118654752;
const glm::dvec3 base(0.2, 0.4, 0.8);

// Appendix B of glTF 2.0 for the plate, of roughness 1 and no metal, seen along its normal: D is 1 / pi and V
// is 1 / (2 (N.L + N.V)). `irradiance` is on a surface that faces the light.
glm::dvec3 lit(double irradiance, double cosine) {
  const double view_half = std::sqrt((1 + cosine) / 2);
  const double fresnel = 0.04 + 0.96 * std::pow(1 - view_half, 5);
  return irradiance * cosine / glm::pi<double>() * ((1 - fresnel) * base + fresnel / (2 * (cosine + 1)));
}

GltfBuilder dark_plate() { return lit_plate(base); }

// A light's node inside a parent that is turned, scaled and moved.
json& add_nested_light(GltfBuilder& made, const json& light, const json& parent) {
  add_light(made, light);
  json& nodes = made.root["nodes"];
  const size_t child = nodes.size() - 1;
  nodes.push_back(parent);
  nodes.back()["children"] = {child};
  made.root["scenes"][0]["nodes"].back() = nodes.size() - 1;
  return nodes[child];
}

TEST(OwnLights, ADirectionalLightShinesAlongItsNodesNegativeZ) {
  GltfBuilder made = dark_plate();
  // Turned by 60 degrees about x: -z goes to (0, sin 60, -cos 60).
  add_light(made, {{"type", "directional"}, {"intensity", 3}})["rotation"] = {0.5, 0, 0, std::sqrt(0.75)};
  for (const glm::dvec3& place : {glm::dvec3(0), {-0.9, 0.9, 0}})
    expect_radiance(shown(made).at(place), lit(3, 0.5));
  // From behind it lights nothing.
  made.root["nodes"].back()["rotation"] = {1, 0, 0, 0};
  expect_radiance(shown(made).at({0, 0, 0}), black);
}

// The parent turns x to y, scales by 2, and lifts by 1: the child at (0.25, 0, 0) is at (0, 0.5, 1).
TEST(OwnLights, APointLightInANestedNode) {
  GltfBuilder made = dark_plate();
  const json parent = {
      {"rotation", {0, 0, root_half, root_half}}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 1}}};
  add_nested_light(made, {{"type", "point"}, {"intensity", 7}}, parent)["translation"] = {0.25, 0, 0};
  const Picture picture = shown(made);
  for (const auto& [column, row] : {std::pair(31, 47), {10, 3}, {60, 33}}) {
    const glm::dvec3 to_light = glm::dvec3(0, 0.5, 1) - pixel_center(column, row);
    const double d = glm::length(to_light);
    expect_radiance(picture.image.at(column, row), lit(7 / (d * d), to_light.z / d));
  }
}

// The window of the extension: 1 - (d / range)^4. A scale does not change the range.
TEST(OwnLights, ARangeEndsTheLight) {
  GltfBuilder made = dark_plate();
  json& node = add_light(made, {{"type", "point"}, {"intensity", 7}, {"range", 1.25}});
  node["translation"] = {0, 0, 1};
  node["scale"] = {9, 9, 9};
  const Picture picture = shown(made);
  for (const auto& [column, row] : {std::pair(32, 32), {44, 30}}) {
    const glm::dvec3 to_light = glm::dvec3(0, 0, 1) - pixel_center(column, row);
    const double d = glm::length(to_light);
    expect_radiance(picture.image.at(column, row),
                    lit(7 / (d * d) * (1 - std::pow(d / 1.25, 4)), to_light.z / d));
  }
  // The range ends 0.75 from the middle.
  expect_radiance(picture.at({0.78, 0, 0}), black);
  EXPECT_GT(picture.at({0.7, 0, 0}).r, 0);
}

// Within the inner angle the full intensity, past the outer one nothing, between them the square of the
// cosine's fraction.
TEST(OwnLights, ASpotFadesBetweenItsAngles) {
  const double inner = 0.3, outer = 0.7;
  GltfBuilder made = dark_plate();
  const json spot = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
  // The parent turns -z to x; the child turns it back, so that the spot shines along -z from (0, 0, 1).
  const json parent = {{"rotation", {0, -root_half, 0, root_half}}, {"translation", {0, 0, 1}}};
  json& node = add_nested_light(made, {{"type", "spot"}, {"intensity", 7}, {"spot", spot}}, parent);
  node["rotation"] = {0, root_half, 0, root_half};
  const Picture picture = shown(made);
  int inside = 0, between = 0, outside = 0;
  for (int column = 0; column < own_size; ++column) {
    SCOPED_TRACE(column);
    const glm::dvec3 to_light = glm::dvec3(0, 0, 1) - pixel_center(column, 27);
    const double d = glm::length(to_light), cosine = to_light.z / d, angle = std::acos(cosine);
    const double share =
        std::clamp((cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
    expect_radiance(picture.image.at(column, 27), share * share * lit(7 / (d * d), cosine));
    inside += angle < inner;
    outside += angle > outer;
    between += angle > inner && angle < outer;
  }
  EXPECT_TRUE(inside > 0 && between > 0 && outside > 0);
}

// Two nodes may carry one light, whose colour multiplies its intensity.
TEST(OwnLights, OneLightOnTwoNodesShinesTwice) {
  GltfBuilder made = dark_plate();
  add_light(made, {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}});
  expect_radiance(shown(made).at({0, 0, 0}), lit(3, 1) * glm::dvec3(1, 0.5, 0));
  made.root["nodes"].push_back(made.root["nodes"].back());
  made.root["scenes"][0]["nodes"].push_back(made.root["nodes"].size() - 1);
  expect_radiance(shown(made).at({0, 0, 0}), 2.0 * lit(3, 1) * glm::dvec3(1, 0.5, 0));
}

}  // namespace
}  // namespace lightgrid
