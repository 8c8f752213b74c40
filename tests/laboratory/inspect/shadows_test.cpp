// The report of `inspect` about shadows, on a frame of a small scene.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "accuracy/frame_shadows.h"
#include "inspect/inspect.h"
#include "plan/settings/shadows.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A wall 4 m away, a ball of 0.7 m at (0.3, -0.2, -3), and one light to the right before it that casts: it
// shades the wall from x -2.6 to 1.1, of which the eye sees the part below x -0.55.
TEST(InspectedShadows, NameWhatHidesALight) {
  SmallScene s = small_scene();
  s.scene.lights.resize(1);
  Light& light = s.scene.lights[0];
  light.position = {0.9, -0.2, -1.8};
  light.radius_m = 5;
  light.casts_shadow = true;
  const View view = small_view(128, 96);
  TechniqueRun run(software_devices(), s.scene, view, {}, find_technique("visibility"));
  run.draw_frame();
  const FrameShadows shadows = read_frame_shadows(run);
  SceneOcclusion occlusion(s.scene);
  const auto verdict_at = [&](int x, int y) {
    PixelInspection pixel{.x = x, .y = y};
    pixel.lights = {{.lit = true}};
    EXPECT_FALSE(add_shadows(pixel, s.scene, shadows.at(x, y, occlusion)));
    return pixel.lights[0].shadow;
  };
  const auto pixel_of = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_view * glm::dvec4(p, 1);
    return glm::ivec2((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(128, 96));
  };
  const glm::ivec2 dark = pixel_of({-0.6, -0.2, -4}), lit = pixel_of({1.6, -0.2, -4});
  const auto hidden = verdict_at(dark.x, dark.y), seen = verdict_at(lit.x, lit.y);
  ASSERT_TRUE(hidden && seen);
  EXPECT_EQ(hidden->truth.sight, Sight::hidden);
  EXPECT_TRUE(hidden->shaded_as_hidden);
  EXPECT_EQ(hidden->by, "ball");
  EXPECT_NEAR(hidden->truth.distance_m, glm::distance(light.position, {0.3, -0.2, -3}), 0.7) << "on the ball";
  EXPECT_EQ(seen->truth.sight, Sight::seen);
  EXPECT_FALSE(verdict_at(0, 0)) << "background";

  // A frame without shadows leaks it.
  FrameShadows unhidden = read_frame_shadows(run);
  unhidden.shaded.reset();
  PixelInspection pixel{.x = dark.x, .y = dark.y};
  pixel.lights = {{.lit = true}};
  EXPECT_TRUE(add_shadows(pixel, s.scene, unhidden.at(dark.x, dark.y, occlusion)));
  EXPECT_TRUE(pixel.lights[0].shadow->leaked());
}

// A sun from the right before the wall, beside a light that casts nothing and another sun: the ball's shadow
// falls to its left.
TEST(InspectedShadows, AreToldOfDirectionalLights) {
  SmallScene s = small_scene();
  s.scene.lights.resize(3);
  for (const int i : {0, 2}) s.scene.lights[size_t(i)].type = LightType::directional;
  s.scene.lights[0].direction = {0, 0, -1};
  Light& sun = s.scene.lights[2];
  sun.direction = glm::normalize(glm::vec3(-1, 0, -1));
  sun.casts_shadow = true;
  sun.name = "sun";
  const View view = small_view(128, 96);
  TechniqueRun run(software_devices(), s.scene, view, {}, find_technique("visibility"));
  run.draw_frame();
  const FrameShadows shadows = read_frame_shadows(run);
  SceneOcclusion occlusion(s.scene);
  const auto sun_at = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_view * glm::dvec4(p, 1);
    const glm::ivec2 at((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(128, 96));
    PixelInspection pixel{.x = at.x, .y = at.y};
    EXPECT_FALSE(add_shadows(pixel, s.scene, shadows.at(at.x, at.y, occlusion)));
    EXPECT_EQ(pixel.directional_shadows.size(), 1u);
    return pixel.directional_shadows.at(0);
  };
  const DirectionalShadow dark = sun_at({-0.7, -0.2, -4}), lit = sun_at({1.6, -0.2, -4});
  EXPECT_EQ(dark.light, 2);
  EXPECT_EQ(dark.shadow.truth.sight, Sight::hidden);
  EXPECT_TRUE(dark.shadow.shaded_as_hidden);
  EXPECT_EQ(lit.shadow.truth.sight, Sight::seen);
  EXPECT_FALSE(lit.shadow.shaded_as_hidden);
  EXPECT_THAT(shadow_words(dark.shadow, sun),
              AllOf(HasSubstr("hidden by node 1 \"ball\" triangle "), HasSubstr(" m from the surface")));
}

// The verdicts are of what blended surfaces hide in the frame: a pane that hides more than half counts, but
// is no triangle to name.
TEST(InspectedShadows, KnowWhatBlendedSurfacesHide) {
  SmallScene s = small_scene_of_casters();
  add_pane_before_wall(s, 0.7f);
  for (Light& light : s.scene.lights) light.radius_m = 8;  // all are in range everywhere
  SceneOcclusion occlusion(s.scene);
  for (const char* setting : {"shadow-blended=none", "shadow-blended=opaque", "shadow-blended=alpha"}) {
    SCOPED_TRACE(setting);
    Settings settings;
    apply_setting(settings, setting);
    TechniqueRun run(software_devices(), s.scene, small_view(64, 48), settings, find_technique("visibility"));
    run.draw_frame();
    const FrameShadows shadows = read_frame_shadows(run);
    int by_pane = 0, by_several = 0;
    for (int i = 0; i < 64 * 48; i += 7) {
      PixelInspection pixel{.x = i % 64, .y = i / 64};
      for (uint32_t light = 0; light < 6; ++light)
        pixel.lights.push_back({.index = light, .light = int(light), .lit = true});
      EXPECT_FALSE(add_shadows(pixel, s.scene, shadows.at(pixel.x, pixel.y, occlusion))) << i;
      for (const LightVerdict& light : pixel.lights) {
        if (!light.shadow || light.shadow->truth.sight != Sight::hidden) continue;
        by_pane += light.shadow->by == "pane";
        if (light.shadow->truth.by.instance >= 0) continue;
        EXPECT_EQ(shadow_words(*light.shadow, s.scene.lights[0]), "hidden by blended surfaces together");
        ++by_several;
      }
    }
    EXPECT_EQ(by_pane > 50, settings[setting::shadow_blended] == BlendedCasters::opaque) << by_pane;
    EXPECT_EQ(by_several > 50, settings[setting::shadow_blended] == BlendedCasters::alpha) << by_several;
  }
}

CapturedFrame frame_of_one_light() {
  CapturedFrame frame;
  frame.view = small_view(16, 16);
  frame.depth.assign(256, 0.1f);
  frame.lights.resize(1);
  frame.lights[0].name = "lamp";
  return frame;
}

PixelInspection inspected(Sight sight, bool shaded_as_hidden) {
  PixelInspection pixel;
  pixel.covered = true;
  LightVerdict verdict{.listed = true, .lit = true};
  verdict.shadow = ShadowVerdict{{sight, {3, 12}, 1.25}, "column", shaded_as_hidden};
  pixel.lights = {verdict};
  return pixel;
}

TEST(InspectedShadows, AreTold) {
  const CapturedFrame frame = frame_of_one_light();
  const auto table = [&](Sight sight, bool shaded) {
    return inspection_table(frame, inspected(sight, shaded), 10);
  };
  EXPECT_THAT(
      table(Sight::hidden, true),
      HasSubstr("light 0 \"lamp\": hidden by node 3 \"column\" triangle 12, 1.250 m from the light\n"));
  EXPECT_THAT(table(Sight::hidden, false), HasSubstr("from the light; the frame shades it: LEAKED\n"));
  EXPECT_THAT(table(Sight::seen, false), HasSubstr("light 0 \"lamp\": seen\n"));
  EXPECT_THAT(table(Sight::seen, true), HasSubstr("light 0 \"lamp\": seen; the frame hides it: ACNED\n"));
  EXPECT_THAT(table(Sight::either, true),
              HasSubstr("light 0 \"lamp\": either: its answer turns on rounding\n"));
  const auto json =
      nlohmann::json::parse(inspection_json(frame, inspected(Sight::hidden, true), FrameGrid{}, 10));
  EXPECT_EQ(json["lights"][0]["shadow"], nlohmann::json::parse(R"({"sight": "hidden", "by": "column",
    "instance": 3, "triangle": 12, "away": 1.25, "shaded_as_hidden": true})"));
}

}  // namespace
}  // namespace lightgrid::lab
