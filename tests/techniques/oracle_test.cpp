// The shaders against the oracle in double, pixel by pixel.
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct Shading : testing::TestWithParam<const char*> {};

// Each light's term carries some 50 roundings of 2^-24, and a sum of n of them at most n more: with the 100
// lights that share a pixel at most, 1e-5 of what is there. A highlight's peak multiplies the rounding of its
// angles by up to 2 / alpha, 20 for the polished materials of these scenes: 2e-4 of the brightest channel.
// Measured (llvmpipe): 2e-6 to 2e-5 at worst, 2e-7 root mean square.
TEST_P(Shading, InFloatIsTheOraclesWithinItsRounding) {
  const Scene scene = find_builtin_scene(GetParam())->make();
  const View view = default_view(scene, 320, 180);
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward"));
  run.run_frame();
  const auto depth = read_depth(run.frame());
  const ReferenceErrors errors = measure_reference_errors(run.frame(), run.image(), depth, 4000);
  const float brightest = brightest_channel(run.image());
  RecordProperty("max_rel", fmt::format("{}", errors.precision.max_rel));
  EXPECT_LT(errors.precision.max_rel, 2e-4);
  EXPECT_LT(errors.precision.rmse, 1e-6 * brightest);
  EXPECT_GT(errors.precision.max_abs, 0) << "float and double agree by no accident";
  EXPECT_GT(errors.model.max_abs, 0) << "the window takes light away";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Shading, testing::Values("hall", "spheres", "terrain", "street"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace lightgrid
