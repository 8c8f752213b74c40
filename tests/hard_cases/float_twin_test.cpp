// Compares the kernels with the float twin outside the catalogue's case (lists/float_twin): other uploads,
// depth inputs and index widths, and numbers of lights for which the kernels use other code paths.
#include <gtest/gtest.h>

#include <cmath>

#include "shared/cull_tests.h"
#include "verify/check.h"
#include "verify/inputs.h"

namespace lightgrid::lab::verify {
namespace {

struct Frame {
  CullView view;
  std::vector<CullLight> lights;
  DepthImage depth;
};

Frame frame_of(const CullView& view, size_t lights, bool spots) {
  Random random(71);
  return {view, scattered_lights(view, lights, spots, random), scattered_depth(view, random)};
}

void expect_the_twins_bytes(const Frame& frame, const CullerOptions& options, bool blend = false) {
  static const auto engine = device_engine("");
  Check check(*engine, 0);
  check.same_as_twin(frame.view, frame.lights, frame.depth, options, blend);
  EXPECT_EQ(check.outcome().verdict, Verdict::pass) << check.outcome().why;
}

const CullView sixty = field_of_view(60, 301, 211);

TEST(FloatTwin, WithoutCones) { expect_the_twins_bytes(frame_of(sixty, 300, false), {}); }

TEST(FloatTwin, WithoutLights) { expect_the_twins_bytes(frame_of(sixty, 0, false), {}); }

TEST(FloatTwin, IndicesOf32Bits) {
  CullerOptions options;
  options.index_bits = 32;
  expect_the_twins_bytes(frame_of(sixty, 300, true), options);
}

TEST(FloatTwin, WholePixels) {
  CullerOptions options;
  options.pixel_centres = false;
  expect_the_twins_bytes(frame_of(sixty, 300, true), options);
}

// Past 256 candidates a bin, and past 16,384 lights, the lanes shape uses another code path.
TEST(FloatTwin, ManyLights) {
  for (const size_t lights : {3000, 20'000}) expect_the_twins_bytes(frame_of(sixty, lights, false), {});
}

TEST(FloatTwin, BlendedSurfaces) {
  for (const DepthBoundsMode mode : {DepthBoundsMode::none, DepthBoundsMode::halfz_modified}) {
    CullerOptions options;
    options.blend = true;
    options.depth_bounds = mode;
    expect_the_twins_bytes(frame_of(sixty, 300, true), options, true);
  }
}

TEST(FloatTwin, SamplesOfAViewportInStandardDepthOf16Bits) {
  Frame frame = frame_of(view_through({.order = DepthOrder::standard}, 90, 50), 300, true);
  const CullView image = view_through({.order = DepthOrder::standard}, 110 * 4, 60);
  Random random(72);
  frame.depth = scattered_depth(image, random);
  frame.depth.row_pixels = 110;
  frame.depth.x = 7;
  frame.depth.y = 5;
  frame.depth.samples = 4;
  CullerOptions options;
  options.depth_format = DepthFormat::d16;
  options.depth_bounds = DepthBoundsMode::mask32;
  expect_the_twins_bytes(frame, options);
}

// Invalid depth values, in every mode.
TEST(FloatTwin, StrangeDepths) {
  Frame frame = frame_of(field_of_view(60, 127, 73), 200, true);
  const float invalid[] = {NAN, -NAN, INFINITY, -INFINITY, -0.0f, -0.5f, 1.5f, 1e-45f, 0.0f, 1.0f};
  for (size_t i = 0; i < frame.depth.values.size(); i += 397)
    frame.depth.values[i] = invalid[i / 397 % std::size(invalid)];
  for (int mode = 1; mode < 5; ++mode) {
    CullerOptions options;
    options.depth_bounds = DepthBoundsMode(mode);
    expect_the_twins_bytes(frame, options);
  }
}

// One light removed from one list, one bit of one bound changed: both are detected.
TEST(FloatTwin, SeesASingleDifference) {
  const Frame frame = frame_of(field_of_view(60, 127, 73), 100, true);
  const auto engine = device_engine("");
  KernelRun run = engine->kernel_run({}, frame.view, frame.lights, frame.depth, false).value();
  const HostGrid twin = twin_grid(run.inputs, CullTest::planes_aabb);
  ASSERT_EQ(difference(twin, run.grid), "");
  ASSERT_GT(run.grid.indices.size(), 100u);
  ++run.grid.indices[50];
  EXPECT_NE(difference(twin, run.grid), "");
  std::vector<float> bounds = run.inputs.bounds;
  bounds[3] = std::nextafter(bounds[3], 0.0f);
  EXPECT_NE(difference(run.inputs.bounds, bounds), "");
  EXPECT_NE(twin_grid(run.inputs, CullTest::sphere), twin);
}

}  // namespace
}  // namespace lightgrid::lab::verify
