// What `inspect` tells of shadows, on a frame of a small scene.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "inspect/inspect.h"
#include "session/frame_shadows.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A wall 4 m away, a ball of 0.7 m at (0.3, -0.2, -3), and one light to the right before it that casts: it
// shades the wall from x -2.6 to 1.1, of which the eye sees the part below x -0.55.
TEST(InspectedShadows, NameWhatHidesALight) {
  SmallScene s = small_scene();
  s.scene.lights.resize(1);
  Light& light = s.scene.lights[0];
  light.position = {0.9, -0.2, -1.8}, light.radius_m = 5, light.casts_shadow = true;
  const View view = small_view(128, 96);
  FrameShadows shadows(software_devices(), s.scene, view, {}, find_technique("visibility"));
  const auto pixel_of = [&](const glm::dvec3& p) {
    const glm::dvec4 clip = view.clip_from_view * glm::dvec4(p, 1);
    return glm::ivec2((glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(128, 96));
  };
  const glm::ivec2 dark = pixel_of({-0.6, -0.2, -4}), lit = pixel_of({1.6, -0.2, -4});
  const auto hidden = shadows.sight(dark.x, dark.y, 0), seen = shadows.sight(lit.x, lit.y, 0);
  ASSERT_TRUE(hidden && seen);
  EXPECT_EQ(hidden->sight, Sight::hidden);
  EXPECT_EQ(s.scene.instances[size_t(hidden->by.instance)].name, "ball");
  EXPECT_NEAR(hidden->distance_m, glm::distance(light.position, {0.3, -0.2, -3}), 0.7) << "on the ball";
  EXPECT_EQ(seen->sight, Sight::seen);
  EXPECT_FALSE(shadows.sight(0, 0, 0)) << "background";
  EXPECT_EQ(shadows.pairs().truth.at(uint32_t(dark.y * 128 + dark.x), 0), Sight::hidden);
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
  EXPECT_THAT(table(Sight::hidden, true),
              HasSubstr("light 0 \"lamp\": hidden by \"column\" triangle 12, 1.250 m from the light\n"));
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
}  // namespace lightgrid
