// The share of lights that effects let through, with effects of this test.
#include "scene/effect_terms.h"

#include <gtest/gtest.h>

#include "oracle/attenuation.h"
#include "oracle/lit_set.h"
#include "oracle/shading.h"
#include "scene/light_groups.h"
#include "scene/light_tree.h"

namespace lightgrid::lab {
namespace {

// Lights shine upwards in the world only, and half as brightly on surfaces whose mask has no bit 3.
ReachTerm upwards(const Scene&, const Light& light, const LightRanges&, const View& view) {
  if (light.name != "up") return {};
  const glm::dvec3 up = glm::dmat3(view.view_from_world) * glm::dvec3(0, 1, 0);
  return [up](const glm::dvec3& from_light, uint32_t mask) {
    return glm::dvec3(glm::dot(up, from_light) <= 0 ? 0 : mask & 8 ? 1 : 0.5);
  };
}

LightShare share_upwards(const Scene&, const Light& light, const LightRanges&) {
  return light.name == "up" ? LightShare{1, true} : LightShare{};
}

// By a setting that is stored with the ranges.
ReachTerm dimmed(const Scene&, const Light&, const LightRanges& ranges, const View&) {
  if (!ranges.effects.contains("dimmed")) return {};
  return [](const glm::dvec3&, uint32_t) { return glm::dvec3(0.25); };
}

LightShare share_dimmed(const Scene&, const Light&, const LightRanges& ranges) {
  return {.largest = ranges.effects.contains("dimmed") ? 0.25 : 1};
}

class EffectTerms : public testing::Test {
 protected:
  EffectTerms() { set_light_oracles({{upwards, share_upwards}, {dimmed, share_dimmed}}); }
  ~EffectTerms() override { set_light_oracles({}); }

  // A camera on its side: the world's upwards is the view's right.
  EffectTerms& look() {
    view.view_from_world = glm::dmat4(glm::dvec4(0, -1, 0, 0), glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0),
                                      glm::dvec4(0, 0, 0, 1));
    scene.lights = {{.name = "up"}, {.name = "plain"}};
    return *this;
  }

  // These terms are the same for all colours.
  static double reaches(const ViewLight& light, const glm::dvec3& position, uint32_t mask) {
    const glm::dvec3 part = light_reaches(light, position, mask);
    EXPECT_EQ(part, glm::dvec3(part.x));
    return part.x;
  }

  Scene scene;
  View view;
  LightRanges dim{.effects = {{"dimmed", 1}}};
};

TEST_F(EffectTerms, AreAskedInTheViewsAxes) {
  look();
  const ViewLight up = lights_in_view(scene, view)[0];
  EXPECT_EQ(reaches(up, {2, 0, 0}, full_mask), 1);  // above it
  EXPECT_EQ(reaches(up, {-2, 0, 0}, full_mask), 0);
  EXPECT_EQ(reaches(up, {2, 1, 0}, 1), 0.5);
  EXPECT_TRUE(is_lit(up, {2, 0, 0}) && !is_lit(up, {-2, 0, 0}));
}

TEST_F(EffectTerms, ADirectionalLightsPointIsItsDirection) {
  look();
  scene.lights[0].type = LightType::directional;
  scene.lights[0].direction = {0, 1, 0};
  EXPECT_EQ(reaches(lights_in_view(scene, view)[0], {-7, 0, 0}, full_mask), 1);
  scene.lights[0].direction = {0, -1, 0};
  EXPECT_EQ(reaches(lights_in_view(scene, view)[0], {7, 0, 0}, full_mask), 0);
}

// A light reaches surfaces with which it shares a bit, the highest too.
TEST_F(EffectTerms, MasksKeepLightsFromSurfaces) {
  look();
  EXPECT_EQ(mask_of(scene.lights[0]), full_mask);
  set_light_oracles({{.masks = {.of_light = [](const Light& light) { return groups_of(light); },
                                .of_instance = [](const Instance& i) { return groups_of(i); }}}});
  set_groups(scene.lights[0], 1u << 31 | 2);
  const std::vector<ViewLight> lights = lights_in_view(scene, view);
  EXPECT_EQ(reaches(lights[0], {0, 0, -1}, 1u << 31), 1);
  EXPECT_EQ(reaches(lights[0], {0, 0, -1}, 6), 1);
  EXPECT_EQ(reaches(lights[0], {0, 0, -1}, ~(1u << 31 | 2)), 0);
  EXPECT_EQ(reaches(lights[1], {0, 0, -1}, 0), 0);
  EXPECT_TRUE(lights[0].share.of_surface && !lights[1].share.of_surface);
  EXPECT_EQ(lights[0].share.largest, 1);
}

TEST_F(EffectTerms, MultiplyAndFollowTheRangesSettings) {
  look();
  const std::vector<ViewLight> plain = lights_in_view(scene, view), dimmer = lights_in_view(scene, view, dim);
  EXPECT_FALSE(plain[1].reach);
  EXPECT_EQ(reaches(dimmer[0], {2, 1, 0}, 1), 0.125);
  EXPECT_EQ(reaches(dimmer[1], {2, 1, 0}, 1), 0.25);
  EXPECT_EQ(dimmer[0].share.largest, 0.25);
  EXPECT_TRUE(dimmer[0].share.of_surface && !dimmer[1].share.of_surface);
  EXPECT_FALSE(dim == LightRanges{});  // code that keeps what it made of the ranges makes it again
}

TEST_F(EffectTerms, ScaleWhatCodeOutsideOfLoopsTakesForBrightness) {
  look();
  scene.lights[1].radius_m = 3;
  const ViewLight plain = lights_in_view(scene, view)[1], dimmer = lights_in_view(scene, view, dim)[1];
  EXPECT_EQ(influence_of(dimmer), influence_of(plain) / 4);
  const auto in_tree = [](const ViewLight& light) {
    return light_tree(std::vector<ViewLight>{light}).nodes[1].low.w;
  };
  EXPECT_EQ(in_tree(dimmer), in_tree(plain) / 4);
}

TEST_F(EffectTerms, AreInTheOraclesShading) {
  look();
  const Surface surface{.normal = {-1, 0, 0}};
  const auto radiance = [&](const LightRanges& ranges, const ShadeSettings& settings = {}) {
    return shade(surface, {2, 0, -1e-3}, true, {lights_in_view(scene, view, ranges)[1]}, settings).r;
  };
  EXPECT_GT(radiance({}), 0);
  EXPECT_DOUBLE_EQ(radiance(dim), radiance({}) / 4);
  // The light that effects add is not scaled.
  const ShadeSettings adds{
      .base = {[](const Surface& s, const glm::dvec3& at) { return s.base_color * at.x; }}};
  EXPECT_DOUBLE_EQ(radiance(dim, adds), radiance(dim) + 2);
}

}  // namespace
}  // namespace lightgrid::lab
