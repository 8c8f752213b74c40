// deferred_tiled and forward_plus_compute: the light loop in OpenCL against forward's in OpenGL.
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"
#include "techniques/rounding_loss.h"

namespace lightgrid {
namespace {

constexpr double exact_enough = 1e-5;  // of the brightest channel
constexpr const char* both[] = {"forward_plus_compute", "deferred_tiled"};

// Runs the technique and checks gates; returns the largest error, of the reference's brightest channel.
double error_of(const char* technique, const Scene& scene, const View& view, const Image& forward,
                const Settings& settings = {}) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  EXPECT_EQ(count_nan_pixels(run.image()), 0u);
  const LitPairs pairs = count_listed_pairs(run, read_depth(run));
  EXPECT_EQ(pairs.lost, 0u);
  EXPECT_EQ(pairs.wrong, 0u);
  return compare_images(run.image(), forward).max_rel;
}

TEST(TiledLightOfScenes, IsForwardsOnEveryBuiltinScene) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.large) continue;
    const Scene scene = builtin.make();
    const View view = default_view(scene, 95, 53);
    const Image forward = render(scene, view, "forward");
    for (const char* technique : both)
      EXPECT_LT(error_of(technique, scene, view, forward), exact_enough) << builtin.name << ' ' << technique;
  }
}

// Narrow highlights in many pixels, the most sensitive to rounding.
TEST(TiledLightOfScenes, IsForwardsInTheHighlightsOfALargeImage) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 1280, 720);
  EXPECT_LT(compare_images(render(scene, view, "deferred_tiled"), render(scene, view, "forward")).max_rel,
            0.5 * exact_enough);
}

TEST(TiledLight, InEverySizeAndTile) {
  const Scene scene = find_builtin_scene("spheres")->make();
  for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {7, 31}}) {
    const View view = default_view(scene, width, height);
    const Image forward = render(scene, view, "forward");
    for (int tile : {8, 16, 64}) {
      EXPECT_LT(error_of("deferred_tiled", scene, view, forward, {{setting::tile, tile}}), exact_enough)
          << width << ' ' << tile;
    }
  }
}

TEST(TiledLight, OfBothKernelShapesAndEveryLoop) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 79, 45);
  for (const Settings& settings :
       {Settings{{setting::kernel_shape, KernelShape::group}}, Settings{{setting::portable, true}},
        Settings{{setting::brdf, Brdf::blinn}}, Settings{{setting::depth_bounds, DepthBoundsMode::none}}}) {
    const Image forward = render(scene, view, "forward", {{setting::brdf, settings[setting::brdf]}});
    EXPECT_LT(error_of("deferred_tiled", scene, view, forward, settings), exact_enough);
  }
}

TEST(TiledLight, LosesIn16And8BitsJustWhatTheGeometryBufferRounds) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 95, 53);
  ASSERT_TRUE(plan_frame(scene, view, {}, {}).surfaces.base_lighting) << "ambient light would be rounded too";
  expect_rounding_explains_the_loss("deferred_tiled", scene, view);
}

TEST(TiledLight, IsNoneWhereThereAreNoLights) {
  Scene scene = find_builtin_scene("hall")->make();
  scene.lights.clear();
  const View view = default_view(scene, 79, 45);
  const Image forward = render(scene, view, "forward");
  for (const char* technique : both)
    EXPECT_TRUE(identical(render(scene, view, technique), forward)) << technique;
}

// docs/techniques/deferred_tiled.md#what-it-costs, computed by hand: 1024 point lights; no spot, directional
// light, z-bin or slice.
TEST(TiledLight, TakesTheMemoryThatItsPageSays) {
  const Scene scene = find_builtin_scene("spheres")->make();
  const View view = default_view(scene, 64, 40);
  const auto result_of = [&](const char* technique, int bits) {
    TechniqueRun run(test_devices(), scene, view, {{setting::buffer_bits, bits}}, find_technique(technique));
    run.run_frame();
    return run.result();
  };
  const size_t pixels = 64 * 40, lights = 1024 * 32 + 3 * 16 + sizeof(ViewParams);
  const size_t beside = result_of("forward_plus", 32).memory_total;
  for (const char* technique : both) {
    for (const auto& [bits, bytes] : {std::pair<int, size_t>(8, 8), {16, 16}, {32, 32}}) {
      const FrameFigures result = result_of(technique, bits);
      EXPECT_EQ(result.memory_gbuffer, pixels * bytes) << technique << ' ' << bits;
      EXPECT_EQ(result.memory_total - beside, pixels * bytes + (pixels + 16) * (bytes + 16) + lights)
          << technique << ' ' << bits;
    }
  }
}

TEST(TiledLight, OfMoreLightsThan16BitsIndex) {
  Scene scene = find_builtin_scene("spheres")->make();
  const Light light = scene.lights.front();
  scene.lights.resize(65'537, light);
  for (size_t i = 1; i < scene.lights.size(); ++i) scene.lights[i].radius_m = 1e-3f;
  const View view = default_view(scene, 16, 9);
  EXPECT_LT(error_of("deferred_tiled", scene, view, render(scene, view, "forward")), exact_enough);
}

}  // namespace
}  // namespace lightgrid
