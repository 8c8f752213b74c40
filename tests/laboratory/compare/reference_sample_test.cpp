#include "compare/reference_sample.h"

#include <gmock/gmock.h>

#include <set>

#include "accuracy/oracle.h"
#include "compare/compare.h"
#include "support/render.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

TEST(ReferenceSample, BlocksCoverEachPixelOnceInAnOrderOfTheSeed) {
  for (const auto& [width, height] : {std::pair(17, 9), {1, 1}, {64, 36}, {3, 40}}) {
    const std::vector<PixelBlock> blocks = shuffled_blocks({width, height}, 1);
    const std::vector<uint32_t> pixels = pixels_of(blocks, {width, height});
    ASSERT_EQ(pixels.size(), size_t(width) * size_t(height));
    for (uint32_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(pixels[i], i);
  }
  const auto first_of = [](uint64_t seed) {
    const PixelBlock block = shuffled_blocks({640, 360}, seed).front();
    return std::pair(block.x, block.y);
  };
  EXPECT_EQ(first_of(1), first_of(1));
  std::set<std::pair<int, int>> different;
  for (uint64_t seed = 0; seed < 10; ++seed) different.insert(first_of(seed));
  EXPECT_GT(different.size(), 8u);
}

// A wrong shuffle would cluster: of a tenth of the blocks, each quarter of the image has about a quarter.
TEST(ReferenceSample, IsSpreadOverTheImage) {
  std::vector<PixelBlock> blocks = shuffled_blocks({640, 360}, 7);
  blocks.resize(blocks.size() / 10);
  int quarters[4] = {};
  for (const PixelBlock& block : blocks) ++quarters[(block.x >= 320) + 2 * (block.y >= 180)];
  for (const int count : quarters)
    EXPECT_NEAR(count, double(blocks.size()) / 4, 6 * std::sqrt(double(blocks.size())) / 4);
}

TEST(ReferenceSample, IsTheImageOfForwardAtItsPixels) {
  SmallScene s = small_scene();
  effect("blend").add(s);  // so that blended surfaces are masked as well
  const View view = small_view(127, 73);
  TechniqueRun run(software_devices(), s.scene, view, {}, find_technique("forward"));
  run.run_frame();
  const Image whole = run.image();
  const std::vector<float> depth = read_depth(run);
  std::vector<PixelBlock> blocks = shuffled_blocks({127, 73}, 3);
  blocks.resize(60);
  Image sampled;
  render_forward_at(run.view(), blocks, sampled);
  const std::vector<uint32_t> pixels = pixels_of(blocks, {127, 73});
  size_t shaded = 0, lit = 0;
  for (const uint32_t pixel : pixels) ASSERT_EQ(sampled.pixels[pixel], whole.pixels[pixel]) << pixel;
  const glm::vec4 background(s.scene.background, 1);
  for (const glm::vec4& pixel : sampled.pixels) shaded += pixel != background;
  for (const uint32_t pixel : pixels) lit += whole.pixels[pixel] != background;
  EXPECT_GT(lit, 0u);
  EXPECT_EQ(shaded, lit) << "pixels outside the sample are shaded";
  EXPECT_EQ(read_depth(run), depth) << "the depth image is not restored";
}

TEST(ReferenceSample, HasFewerPixelsTheMoreLightsThereAre) {
  EXPECT_EQ(sample_size(0), 65536u);
  EXPECT_EQ(sample_size(1'000'000), 4000u);
  EXPECT_EQ(sample_size(100'000'000), 256u);
}

CompareReport compared(ReferencePixels reference, double max_ms, std::string* notice = nullptr) {
  const Scene scene = small_scene().scene;
  const View view = small_view(640, 360);
  CompareOptions options{
      .frames = 1, .warmup = 0, .shaded_samples = 50, .reference = reference, .max_reference_ms = max_ms};
  if (notice) options.notice = [=](const std::string& what) { *notice = what; };
  return compare_techniques(software_devices(), scene, view,
                            {{&find_technique("forward"), {}}, {&find_technique("deferred"), {}}}, options);
}

TEST(ReferenceSample, IsTakenWhereAllPixelsWouldTakeTooLong) {
  std::string notice;
  const CompareReport report = compared(ReferencePixels::automatic, 1e-3, &notice);
  EXPECT_EQ(report.reference_pixels, 65536u);
  EXPECT_THAT(notice, testing::HasSubstr("65,536 of 230,400 pixels"));
  EXPECT_THAT(report.rows[0].refused, testing::HasSubstr("would take about"));
  EXPECT_TRUE(report.rows[1].refused.empty());
  const CompareReport full = compared(ReferencePixels::full, 1e-3);
  EXPECT_EQ(full.reference_pixels, 230400u);
  EXPECT_TRUE(full.rows[0].refused.empty());
  // The same error, over fewer pixels.
  EXPECT_GT(report.rows[1].error->max_abs, 0);
  EXPECT_LE(report.rows[1].error->max_abs, full.rows[1].error->max_abs);
  EXPECT_EQ(report.rows[1].pairs->lit, full.rows[1].pairs->lit);
}

TEST(ReferenceSample, IsNotTakenWhereThereIsTime) {
  EXPECT_EQ(compared(ReferencePixels::automatic, 60e3).reference_pixels, 230400u);
}

// More pixels take longer, and a frame's estimate is of the order of its time.
TEST(ReferenceSample, EstimatesTheTimeOfAFrame) {
  Scene scene = small_scene().scene;
  for (int i = 0; i < 2000; ++i) add_point(scene, "lamp", {0.001f * float(i) - 1, 0, -3}, {1, 1, 1}, 1, 3);
  const View view = small_view(640, 360);
  TechniqueRun run(software_devices(), scene, view, {}, find_technique("forward"));
  const double estimate_ms = estimate_forward_ms(run.view(), shuffled_blocks({640, 360}, 1));
  const Timer timer;
  run.run_frame();
  const double ms = timer.elapsed_ms();
  EXPECT_GT(estimate_ms, ms / 10);
  EXPECT_LT(estimate_ms, ms * 10);
}

}  // namespace
}  // namespace lightgrid::lab
