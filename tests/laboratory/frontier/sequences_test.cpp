// Sequences of frames of a small scene, and which pixels of a frame show what the one before did.
#include "frontier/sequences.h"

#include <gmock/gmock.h>

#include <numbers>

#include "accuracy/oracle.h"
#include "measures/metrics.h"
#include "support/devices.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

namespace lightgrid::lab {
namespace {

constexpr int width = 24, height = 16;

View view_from(const glm::dvec3& eye) {
  return make_view(look_at(eye, eye + glm::dvec3(0, 0, -1)), width, height);
}

// The depth of a wall across the view: reversed, of an infinite far plane.
float depth_at(const View& view, double distance_m) { return float(view.near_m / distance_m); }

double weight_of(const CarriedPixel& pixel, int x, int y) {
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    if (pixel.x + k % 2 == x && pixel.y + k / 2 == y) sum += pixel.weights[k];
  }
  return sum;
}

double sum_of(const CarriedPixel& pixel) {
  return pixel.weights[0] + pixel.weights[1] + pixel.weights[2] + pixel.weights[3];
}

// The camera moves to the right by as much as a pixel spans on the wall, 4 m away.
TEST(CarriedPixels, FollowAWallAndLeaveWhatIsFarWhereItIs) {
  const double pixel_m = 2 * 4 * std::tan(std::numbers::pi / 6) / height;
  const View before = view_from({0, 0, 0}), view = view_from({pixel_m, 0, 0});
  std::vector<float> depth(width * height, depth_at(view, 4));
  for (int x = 0; x < width; ++x) depth[x] = 0;  // the lowest row shows nothing
  const std::vector<CarriedPixel> carried = carried_pixels(view, depth, before, depth);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const CarriedPixel& pixel = carried[size_t(y * width + x)];
      const int from = y == 0 ? x : x + 1;
      if (from < width) {
        EXPECT_NEAR(weight_of(pixel, from, y), 1, 1e-5) << x << "," << y;
      } else {
        EXPECT_LT(sum_of(pixel), 1.5);  // at the image's edge: rounding decides
      }
    }
  }
}

TEST(CarriedPixels, InterpolateBetweenPixels) {
  const double pixel_m = 2 * 4 * std::tan(std::numbers::pi / 6) / height;
  const View before = view_from({0, 0, 0}), view = view_from({0.25 * pixel_m, 0.5 * pixel_m, 0});
  const std::vector<float> depth(width * height, depth_at(view, 4));
  const CarriedPixel pixel = carried_pixels(view, depth, before, depth)[5 * width + 7];
  EXPECT_NEAR(weight_of(pixel, 7, 5), 0.75 * 0.5, 1e-5);
  EXPECT_NEAR(weight_of(pixel, 8, 5), 0.25 * 0.5, 1e-5);
  EXPECT_NEAR(weight_of(pixel, 7, 6), 0.75 * 0.5, 1e-5);
  EXPECT_NEAR(weight_of(pixel, 8, 6), 0.25 * 0.5, 1e-5);
}

// Forward: what the middle of the image shows was nearer to the middle.
TEST(CarriedPixels, FollowADolly) {
  const View before = view_from({0, 0, 0}), view = view_from({0, 0, -1});
  const std::vector<float> depth(width * height, depth_at(view, 3)),
      depth_before(width * height, depth_at(before, 4));
  const CarriedPixel pixel = carried_pixels(view, depth, before, depth_before)[8 * width + 23];
  // 11.5 pixels from the middle at 3 m are 8.625 at 4 m, and 0.5 are 0.375.
  EXPECT_NEAR(weight_of(pixel, 20, 8) + weight_of(pixel, 20, 7), 1 - 0.125, 1e-5);
  EXPECT_NEAR(weight_of(pixel, 21, 8) + weight_of(pixel, 21, 7), 0.125, 1e-5);
  EXPECT_NEAR(sum_of(pixel), 1, 1e-5);
}

TEST(CarriedPixels, AreNotFromAnotherSurface) {
  const View view = view_from({0, 0, 0});
  std::vector<float> depth(width * height, depth_at(view, 4)), nearer = depth;
  nearer[5 * width + 7] = depth_at(view, 3.5);
  nearer[6 * width + 7] = depth_at(view, 3.9);  // within 5 %
  const std::vector<CarriedPixel> carried = carried_pixels(view, depth, view, nearer);
  EXPECT_LT(sum_of(carried[5 * width + 7]), 1e-5 + 1e-5) << "hidden before";
  EXPECT_NEAR(weight_of(carried[6 * width + 7], 7, 6), 1, 1e-5);
  EXPECT_NEAR(weight_of(carried[5 * width + 8], 8, 5), 1, 1e-5);
}

// Depths and pictures of the renderer. Where the camera moved, the frame before is nearer to the frame once
// it is carried; where it rests, carrying changes nothing.
TEST(CarriedPixels, BringTheFrameBeforeToTheFrame) {
  const SmallScene s = small_scene();
  GpuScene gpu(software_devices(), s.scene);
  const auto at = [&](const glm::dvec3& eye) {
    return make_view(look_at(eye, eye + glm::dvec3(0, 0, -1)), 96, 60);
  };
  for (const bool own_surfaces : {false, true}) {
    const BruteForce brute(software_devices(), gpu, {}, {}, own_surfaces);
    const View before = at({0, 0, 0}), view = at({0.1, 0.05, -0.2});
    const auto run = brute.truth_run(before);
    const auto drawn = [&](const View& of) {
      run->look(of);
      run->run_frame(true);
      return std::pair(shown_image(run->image(), {}), read_depth(*run));
    };
    const auto [first, first_depth] = drawn(before);
    const auto [frame, depth] = drawn(view);
    const SeenByFlip seen(frame);
    const double still = mean_of(step_map(frame, seen, first, {})),
                 carried =
                     mean_of(step_map(frame, seen, first, carried_pixels(view, depth, before, first_depth)));
    EXPECT_GT(still, 0.02) << own_surfaces;
    EXPECT_LT(4 * carried, still) << own_surfaces;
    const auto resting = carried_pixels(view, depth, view, depth);
    EXPECT_LT(mean_of(step_map(frame, seen, frame, resting)), 1e-3) << own_surfaces;
    EXPECT_TRUE(
        std::ranges::all_of(resting, [](const CarriedPixel& p) { return std::abs(sum_of(p) - 1) < 1e-5; }));
  }
}

// Without ranges a point is the truth; with ranges its error rests with the camera; random ranges flicker.
TEST(Sequences, TellRandomPointsFromTheOthers) {
  SmallScene s = small_scene();
  for (Light& light : s.scene.lights) light.radius_m = 2.5f;
  const std::vector<Light> rest = s.scene.lights;
  GpuScene gpu(software_devices(), s.scene);
  const View view = small_view(48, 30);
  FrontierJob job;
  const std::vector<std::string> names = {"visibility:range=infinite", "visibility",
                                          "visibility:range=stochastic", "alpha=1"};
  job.points = chosen_points(names, {}, job.common, true);
  ASSERT_EQ(job.points.size(), 3u);
  const TempFolder folder;
  RecordFile file(folder.path / "records.jsonl", FrontierPart{.request = "r", .commit = "c"}, nullptr);
  std::vector<MeasuredPoint> points;
  std::vector<Image> before;
  for (const ChosenPoint& point : job.points) {
    points.push_back({PointRun(software_devices(), gpu, view, point, std::make_shared<TargetPool>()), {}});
    points.back().run.draw();
    before.push_back(points.back().run.image());
    FrontierRecord record;
    record.point = described("small", point);
    record.exposure_ev = 0;
    points.back().records.push_back(record);
    file.begin(record);
  }
  measure_sequences(software_devices(), gpu, s.scene, SceneChoice(), view, job, points, file);

  ASSERT_TRUE(points[0].records[0].errors.sequences);
  for (const auto& [key, sequence] : {std::pair("still", &SequenceErrors::still),
                                      {"dolly", &SequenceErrors::dolly},
                                      {"lights", &SequenceErrors::moving_lights}}) {
    const auto of = [&](size_t point) { return (*points[point].records[0].errors.sequences).*sequence; };
    EXPECT_LT(of(0).plain.flicker.mean, 1e-3) << key;
    EXPECT_LT(of(0).plain.displayed.mean, 1e-3) << key;
    EXPECT_GT(of(1).plain.displayed.mean, 0.02) << key;
    EXPECT_GT(of(2).plain.flicker.mean, 0.01) << key;
    EXPECT_LT(3 * of(1).plain.flicker.mean, of(2).plain.flicker.mean) << key;
    EXPECT_LT(2 * of(2).filtered.flicker.mean, of(2).plain.flicker.mean) << key;
    EXPECT_GE(of(2).plain.largest_flicker, of(2).plain.flicker.mean) << key;
  }
  EXPECT_EQ(points[1].records[0].errors.sequences->still.plain.flicker.mean, 0);
  EXPECT_GT(points[1].records[0].errors.sequences->moving_lights.plain.flicker.mean, 0) << "lights move";
  // A restart finds them, and everything is as it was.
  const auto open = file.open_records().find(record_key(points[2].records[0]));
  ASSERT_NE(open, file.open_records().end());
  EXPECT_EQ(open->second.errors.sequences->dolly.plain.flicker.mean,
            points[2].records[0].errors.sequences->dolly.plain.flicker.mean);
  EXPECT_EQ(s.scene.lights, rest);
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].run.look(view);
    points[i].run.go_to_frame(0);
    points[i].run.draw();
    EXPECT_TRUE(compare_images(points[i].run.image(), before[i]).bit_identical) << job.points[i].label;
  }
}

}  // namespace
}  // namespace lightgrid::lab
