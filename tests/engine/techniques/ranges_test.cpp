// Where lights end (scene/light_ranges.h): every technique draws forward's picture, forward the oracle's; and
// the mean over random ranges is the picture without ranges.
#include "accuracy/oracle_sample.h"
#include "plan/settings/model.h"
#include "support/small_scene.h"
#include "techniques/lidr_scenes.h"
#include "techniques/moments.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

const LightRanges random_ranges{.range = LightRange::stochastic, .alpha = 1, .seed = 3};

Settings with(const LightRanges& ranges) {
  Settings settings;
  set_ranges(settings, ranges);
  return settings;
}

struct RandomRanges : testing::TestWithParam<const Technique*> {};

TEST_P(RandomRanges, DrawForwardsPicture) {
  if (GetParam()->approximate) GTEST_SKIP() << "draws another picture";
  SmallScene s = small_scene();
  add_spot(s.scene, "torch", {0, 0, -1}, {-0.5f, 0, -4}, {1, 1, 1}, 9, 5, 10, 25);
  const View view = small_view(47, 31);
  const Image forward = render(s.scene, view, "forward", with(random_ranges));
  ASSERT_FALSE(same_bytes(forward, render(s.scene, view, "forward")));
  expect_close(s.scene, view, with(random_ranges), forward, GetParam()->name, other_order);
}

INSTANTIATE_TEST_SUITE_P(Techniques, RandomRanges, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

struct Ranges : testing::TestWithParam<LightRanges> {};

TEST_P(Ranges, AreShadedAsTheOracleDoes) {
  SmallScene s = small_scene();
  add_spot(s.scene, "torch", {0, 0, -1}, {-0.5f, 0, -4}, {1, 1, 1}, 9, 5, 10, 25);
  const View view = small_view(47, 31);
  TechniqueRun run(test_devices(), s.scene, view, with(GetParam()), find_technique("forward"));
  run.run_frame();
  const ReferenceErrors errors = measure_reference_errors(run.view(), run.image(), read_depth(run), 1u << 20);
  // A hard edge may fall on either side of a pixel that lies on it: none does here.
  EXPECT_LT(errors.precision.max_rel, 1e-5);
  expect_exact(s.scene, view, with(GetParam()), run.image());
  expect_near(render(s.scene, view, "visibility", with(GetParam())), run.image());
}

INSTANTIATE_TEST_SUITE_P(
    Of, Ranges,
    testing::Values(LightRanges{.range = LightRange::cutoff, .cutoff = 1},
                    LightRanges{.range = LightRange::cutoff, .window = RangeWindow::smooth, .cutoff = 0.5},
                    LightRanges{.window = RangeWindow::none}, LightRanges{.range = LightRange::infinite},
                    random_ranges));

constexpr int seeds = 1024;

struct Stochastic : testing::Test {
  Stochastic() {
    s = small_scene();
    add_spot(s.scene, "torch", {0, 0, -1}, {-0.5f, 0, -4}, {1, 1, 1}, 9, 5, 10, 25);
    run.emplace(test_devices(), s.scene, small_view(32, 18), with(random_ranges),
                find_technique("forward_plus"));
    run->run_frame();
    depth = read_depth(*run);
    oracle.emplace(run->view(), depth);
    truth = channels(oracle->shade(oracle->pixels(), false));
  }

  SmallScene s;
  std::optional<TechniqueRun> run;
  std::vector<float> depth;
  std::optional<SurfaceOracle> oracle;
  std::vector<double> truth;
};

TEST_F(Stochastic, MeanOverSeedsConvergesToThePictureWithoutRanges) {
  Moments single(truth.size()), of_16(truth.size());
  std::vector<double> sum(truth.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    run->draw_random(uint32_t(seed));
    run->run_frame();
    const std::vector<double> values = channels(run->image(), oracle->pixels());
    single.add(values);
    for (size_t i = 0; i < values.size(); ++i) sum[i] += values[i] / 16;
    if (seed % 16 == 0) {
      of_16.add(sum);
      sum.assign(sum.size(), 0);
    }
  }
  const double brightest = *std::ranges::max_element(truth);
  EXPECT_GE(share_within_four_errors(single, truth, 1e-6 * brightest), 0.999);
  EXPECT_GT(share_that_varies(single), 0.5) << "little random is tested";
  // Independent frames give 16. Few lights decide all pixels, and 64 means of 16 tell one light's variance to
  // 18 %.
  EXPECT_NEAR(mean_variance(single) / mean_variance(of_16), 16, 3);
}

// The check sees it if the weight 1 / p is left out: by the oracle, at the same seeds.
TEST_F(Stochastic, WithoutItsWeightTheMeanIsFarFromThatPicture) {
  Moments unweighted(truth.size());
  LightRanges ranges = random_ranges;
  const SurfaceImages surfaces = read_surfaces(run->view());
  for (int seed = 1; seed <= seeds; seed += 8) {
    ranges.seed = uint32_t(seed);
    std::vector<ViewLight> lights = lights_in_view(s.scene, run->view().view, ranges);
    for (ViewLight& light : lights) light.min_falloff = 0;
    unweighted.add(channels(shade_pixels(
        run->view().view, depth, [&](uint32_t pixel) { return surface_of(surfaces, pixel); }, lights,
        {.ambient = s.scene.ambient}, oracle->pixels())));
  }
  EXPECT_LT(share_within_four_errors(unweighted, truth, 0), 0.5);
}

}  // namespace
}  // namespace lightgrid
