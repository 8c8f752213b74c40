// Output of `inspect` for a light: on a cell solved by hand, and its agreement with the lists and the oracle.
#include "inspect/inspect.h"

#include <algorithm>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "frames/captured_frame.h"
#include "frames/frame_lists.h"
#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "support/render.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Inspected {
  FrameGrid grid;
  PixelInspection pixel;
};

Inspected inspect(const CapturedFrame& frame, int x, int y, const Settings& settings = {}) {
  FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, settings);
  culler.run();
  Inspected inspected{culler.grid(), {}};
  inspected.pixel = inspect_pixel(frame, inspected.grid, culler.intervals(), settings,
                                  {x, flipped_row(y, frame.view.height)});
  return inspected;
}

Light light_at(glm::dvec3 position, float radius_m) {
  Light light;
  light.position = position;
  light.radius_m = radius_m;
  return light;
}

// One tile, a field of 90 degrees, everything 10 m away: the cell is a square of that distance.
CapturedFrame wall_at_ten_metres() {
  CapturedFrame frame;
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.fov_y_rad = glm::radians(90.0);
  camera.near_m = 1;
  frame.view = make_view(camera, 16, 16);
  frame.depth.assign(256, 0.1f);
  return frame;
}

constexpr double side = 10 * (1 - 2 * cell_inset / 16);  // half the cell's width, metres
constexpr double slope = side / 10;

TEST(Inspect, SaysWhichTestDroppedALightAndByHowMuch) {
  CapturedFrame frame = wall_at_ten_metres();
  frame.lights = {light_at({0, 0, -10.5}, 2), light_at({0, 0, -13}, 2), light_at({20, 0, -10}, 2)};
  const PixelInspection pixel = inspect(frame, 8, 8).pixel;
  EXPECT_NEAR(pixel.distance_m, 10, 1e-5);
  EXPECT_NEAR(pixel.near_m, 10, 1e-4);
  EXPECT_NEAR(pixel.far_m, 10, 1e-4);
  EXPECT_EQ(pixel.covered_pixels, 256);
  ASSERT_EQ(pixel.lights.size(), 3u);

  EXPECT_TRUE(pixel.lights[0].listed);
  EXPECT_TRUE(pixel.lights[0].lit);
  EXPECT_NEAR(pixel.lights[0].margin_m, 1.5, 1e-4);
  EXPECT_EQ(pixel.lights[0].lit_pixels, 4);  // pixels are 1.25 m apart, from 0.625: one in each direction

  EXPECT_FALSE(pixel.lights[1].listed);
  EXPECT_EQ(pixel.lights[1].light, 1);
  EXPECT_EQ(pixel.lights[1].test, "interval");
  EXPECT_NEAR(pixel.lights[1].margin_m, -1, 1e-4);

  EXPECT_FALSE(pixel.lights[2].listed);
  EXPECT_EQ(pixel.lights[2].test, "planes");
  EXPECT_NEAR(pixel.lights[2].margin_m, 2 - (20 - 10 * slope) / std::sqrt(1 + slope * slope), 1e-4);
  EXPECT_NEAR(pixel.lights[2].margins.interval, 2, 1e-4);
  EXPECT_NEAR(pixel.lights[2].margins.aabb, 2 - (20 - side), 1e-4);
  EXPECT_NEAR(pixel.lights[2].margins.exact, 2 - (20 - side), 1e-4);
  EXPECT_FALSE(pixel.lights[2].margins.cone);
}

TEST(Inspect, SaysThatAConeDroppedASpot) {
  CapturedFrame frame = wall_at_ten_metres();
  Light spot = light_at({0, 0, 15}, 30);  // behind the camera, 25 m from the wall
  spot.type = LightType::spot;
  spot.direction = {0, 0, 1};
  spot.outer_cone_rad = 0.1f;
  frame.lights = {spot};
  spot.direction = {0, 0, -1};
  frame.lights.push_back(spot);
  const PixelInspection pixel = inspect(frame, 8, 8).pixel;
  EXPECT_EQ(pixel.lights[0].light, 1);
  EXPECT_TRUE(pixel.lights[0].listed);
  EXPECT_TRUE(pixel.lights[0].touches);
  EXPECT_TRUE(pixel.lights[0].lit);
  EXPECT_EQ(pixel.lights[0].lit_pixels, 12);  // 25 tan(0.1) = 2.51 m around the axis
  EXPECT_FALSE(pixel.lights[1].listed);
  EXPECT_FALSE(pixel.lights[1].touches);
  EXPECT_EQ(pixel.lights[1].test, "cone");
  EXPECT_NEAR(pixel.lights[1].margin_m, side * std::sqrt(2.0) - 25,
              1e-3);  // the sphere around the wall against 25 m
}

TEST(Inspect, OfACellWithoutASurfaceSaysSo) {
  CapturedFrame frame = wall_at_ten_metres();
  frame.lights = {light_at({0, 0, -10}, 2)};
  frame.depth.assign(256, 0.0f);
  const Inspected inspected = inspect(frame, 0, 0);
  EXPECT_FALSE(inspected.pixel.covered);
  EXPECT_EQ(inspected.pixel.lights[0].test, "empty");
  EXPECT_THAT(inspection_table(frame, inspected.pixel, 10), HasSubstr("background"));
  const auto json = nlohmann::json::parse(inspection_json(frame, inspected.pixel, inspected.grid, 10));
  EXPECT_TRUE(json["distance"].is_null());
  EXPECT_EQ(json["cell"]["empty"], true);
}

// For every setting: verdicts equal the list's and the oracle's; the exact distance is never below another
// test's; a light that touches is listed; and each drop is explained by a test in use.
TEST(Inspect, AgreesWithTheListsTheOracleAndItself) {
  const CapturedFrame frame = small_frame(61, 37);
  const std::vector<ViewLight> lights = local_lights(frame);
  int kept = 0, dropped = 0;
  for (const SettingRow& setting : setting_rows()) {
    const char* const keys[] = {"cull-test", "tile", "depth-bounds", "slices", "z-bins", "grid-lists"};
    if (std::ranges::find(keys, setting.key) == std::end(keys)) continue;
    for (const std::string& value : setting.values) {
      SCOPED_TRACE(setting.key + "=" + value);
      const Settings settings = frame_settings(frame, {setting.key + "=" + value});
      const TechniqueNeeds needs{
          .lists = {.slices = setting.key == "slices", .z_bins = setting.key == "z-bins"}};
      FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, settings, needs);
      culler.run();
      const FrameGrid grid = culler.grid();
      const std::vector<DepthInterval> intervals = culler.intervals();
      for (int y = 1; y < 37; y += 7) {
        for (int x = 2; x < 61; x += 9) {
          const PixelInspection pixel =
              inspect_pixel(frame, grid, intervals, settings, {x, flipped_row(y, frame.view.height)});
          ASSERT_EQ(pixel.lights.size(), lights.size());
          EXPECT_EQ(pixel.lost(), 0);
          EXPECT_EQ(pixel.directional, 3);
          for (const LightVerdict& v : pixel.lights) {
            const float depth = frame.depth[size_t(y) * 61 + x];
            EXPECT_EQ(v.lit,
                      depth > 0 && is_lit(lights[v.index], position_from_depth(frame.view, x, y, depth)));
            if (v.lit) {
              EXPECT_GT(v.lit_pixels, 0);
            }
            (v.listed ? kept : dropped) += 1;
            if (v.test == "empty") continue;
            const TestMargins& m = v.margins;
            if (std::isfinite(m.exact)) {
              EXPECT_LE(m.exact, std::min({m.interval, m.planes, m.aabb, m.sphere}) + 1e-9);
            }
            if (v.touches && !m.pieces && v.test != "z-bins") {
              EXPECT_TRUE(v.listed) << v.index;
            }
            if (v.listed) {
              EXPECT_GT(v.margin_m, -1e-3) << v.index << " " << v.test;
            }
            if (!v.listed) {
              EXPECT_LT(v.margin_m, 0) << v.index << " " << v.test;
              EXPECT_NE(v.test, "other") << v.index;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(dropped, 1000);
}

TEST(Inspect, ShowsTheNearestDroppedLightsAndEveryLostOne) {
  CapturedFrame frame = wall_at_ten_metres();
  for (int i = 0; i < 9; ++i) frame.lights.push_back(light_at({0, 0, -20.0 - 5 * i}, 2));
  frame.lights.push_back(light_at({0, 0, -10}, 3));
  Inspected inspected = inspect(frame, 8, 8);
  auto json = nlohmann::json::parse(inspection_json(frame, inspected.pixel, inspected.grid, 2));
  ASSERT_EQ(json["lights"].size(), 3u);
  EXPECT_EQ(json["lights"][0]["light"], 9);
  EXPECT_EQ(json["lights"][1]["light"], 0);
  EXPECT_EQ(json["lights"][2]["light"], 1);
  EXPECT_EQ(json["dropped_not_shown"], 7);
  EXPECT_THAT(inspection_table(frame, inspected.pixel, 2), Not(HasSubstr("LOST")));

  inspected.pixel.lights[0].listed = false;  // as if the culler had lost it
  json = nlohmann::json::parse(inspection_json(frame, inspected.pixel, inspected.grid, 0));
  EXPECT_EQ(json["lost"], 1);
  ASSERT_EQ(json["lights"].size(), 1u);
  EXPECT_THAT(inspection_table(frame, inspected.pixel, 0), HasSubstr("LOST"));
}

TEST(InspectMaps, CountListedLightsFalsePositivesAndLostOnes) {
  CapturedFrame frame = wall_at_ten_metres();
  frame.lights = {light_at({0, 0, -10.5}, 2), light_at({6, 0, -10}, 30), light_at({0, 6, -10}, 30)};
  FrameGrid grid = inspect(frame, 0, 0).grid;
  const InspectionMaps whole = inspection_maps(frame, grid);
  EXPECT_EQ(whole.covered, 256u);
  EXPECT_EQ(whole.listed, std::vector<uint32_t>(256, 3));
  EXPECT_EQ(whole.lost, std::vector<uint32_t>(256, 0));
  EXPECT_EQ(whole.false_positives[8 * 16 + 8], 0u);  // the first light reaches the four pixels in the middle
  EXPECT_EQ(whole.false_positives[0], 1u);

  grid.lists.indices = {0, 1};
  grid.lists.cells[0].y = 2;  // the third is lost everywhere
  const InspectionMaps holed = inspection_maps(frame, grid);
  EXPECT_EQ(holed.pairs.lost, 256u);
  EXPECT_EQ(holed.lost, std::vector<uint32_t>(256, 1));
  EXPECT_EQ(holed.listed, std::vector<uint32_t>(256, 2));
  EXPECT_EQ(holed.false_positives, whole.false_positives);
}

}  // namespace
}  // namespace lightgrid::lab
