// Forward+ gives the bytes of the brute-force image, under every setting. every_way_test.cpp has the scenes
// that it shares with other techniques.
#include <cmath>

#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "shared/cull_tests.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct BuiltinForwardPlus : testing::TestWithParam<const char*> {
  const Scene scene = find_builtin_scene(GetParam())->make();
};

TEST_P(BuiltinForwardPlus, EveryEffectOnChangesNoByte) {
  const View view = default_view(scene, 160, 90);
  for (const char* technique : {"forward", "forward_plus"}) {
    EXPECT_TRUE(identical(render(scene, view, technique, {{setting::everything_on, true}}),
                          render(scene, view, technique)))
        << technique;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinForwardPlus, testing::Values("hall", "spheres", "terrain", "street"),
                         [](const auto& info) { return std::string(info.param); });

TEST(ForwardPlus, HasTheBytesUnderEverySetting) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 127, 73);
  const Image forward = render(scene, view, "forward");
  for (const CullTest test :
       {CullTest::sphere, CullTest::planes, CullTest::aabb, CullTest::planes_aabb, CullTest::exact}) {
    for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
      SCOPED_TRACE(fmt::format("test {} shape {}", int(test), int(shape)));
      expect_exact(scene, view, {{setting::cull_test, test}, {setting::kernel_shape, shape}}, forward);
    }
  }
  constexpr DepthBoundsMode modes[] = {DepthBoundsMode::minmax, DepthBoundsMode::none, DepthBoundsMode::halfz,
                                       DepthBoundsMode::halfz_modified, DepthBoundsMode::mask32};
  for (const DepthBoundsMode mode : modes) {
    for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
      SCOPED_TRACE(fmt::format("bounds {} shape {}", int(mode), int(shape)));
      expect_exact(scene, view, {{setting::depth_bounds, mode}, {setting::kernel_shape, shape}}, forward);
    }
  }
  for (const int tile : {8, 32, 64}) {
    for (const DepthBoundsMode mode : {DepthBoundsMode::minmax, DepthBoundsMode::none}) {
      SCOPED_TRACE(fmt::format("tile {} bounds {}", tile, int(mode)));
      expect_exact(scene, view, {{setting::depth_bounds, mode}, {setting::tile, tile}}, forward);
    }
  }
}

TEST(ForwardPlus, ALightAtTheEyeAndLightsOnTheSurface) {
  SmallScene s = small_scene(false);
  s.scene.instances.pop_back();
  for (const glm::vec3 at : {glm::vec3(0), glm::vec3(0, 0, -4), glm::vec3(0.5f, 0.25f, -4)}) {
    add_point(s.scene, "lamp", at, {1, 1, 1}, 1, 3);
    add_spot(s.scene, "torch", at, at + glm::vec3(0, 0, -1), {1, 1, 1}, 1, 3, 0, 0.1f);
  }
  const View view = small_view(17, 9);
  const Image forward = render(s.scene, view, "forward");
  for (const glm::vec4& pixel : forward.pixels) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(std::isfinite(pixel[i]) && pixel[i] >= 0);
  }
  expect_exact(s.scene, view, {}, forward);
}

// Light 0 needs no special case.
TEST(ForwardPlus, OneLightAlone) {
  SmallScene s = small_scene(false);
  const View view = small_view(127, 73);
  const Image dark = render(s.scene, view, "forward_plus");
  add_point(s.scene, "lamp", {0, 0.5f, -3.2f}, {1, 1, 1}, 2, 1.5f);
  const Image lit = render(s.scene, view, "forward");
  EXPECT_FALSE(same_bytes(lit, dark));
  expect_exact(s.scene, view, {}, lit);
}

// n equal terms summed in float have an error of at most n * 2^-24 of the sum, here 6e-5; plus the rounding
// of adding base lighting.
TEST(ForwardPlus, AThousandLightsInOnePlaceAreOneOfAThousandfoldIntensity) {
  SmallScene s = small_scene(false);
  const View view = small_view(127, 73);
  add_point(s.scene, "lamp", {0, 0.5f, -3.2f}, {1, 1, 1}, 1000, 1.5f);
  const Image one = render(s.scene, view, "forward_plus");
  s.scene.lights[0].intensity = 1;
  s.scene.lights.resize(1000, s.scene.lights[0]);
  const Image forward = render(s.scene, view, "forward");
  EXPECT_LT(compare_images(forward, one).max_rel, 1000 * 0x1p-24);
  expect_exact(s.scene, view, {}, forward);
}

// Blended surfaces are lit by lights that reach no opaque one.
TEST(ForwardPlus, ALightBeforeEverythingOpaqueLightsTheGlass) {
  SmallScene s = small_scene(false);
  effect("blend").add(s);
  const View view = small_view(127, 73);
  const Image dark = render(s.scene, view, "forward_plus");
  add_point(s.scene, "lamp", {-0.5f, 0, -1.8f}, {1, 1, 1}, 2, 0.5f);
  const Image forward = render(s.scene, view, "forward");
  EXPECT_GT(compare_images(forward, dark).max_abs, 0.01);
  EXPECT_TRUE(identical(render(s.scene, view, "forward_plus"), forward));
}

// Viewer, surface and light on one line, the light behind the surface: the half vector vanishes.
TEST(ForwardPlus, ALightStraightBehindASurfaceAddsNothing) {
  SmallScene s = small_scene(false);
  s.scene.instances.pop_back();  // the wall alone
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9)}) {
    for (const float roughness : {0.0f, 1.0f}) {
      s.scene.materials[s.wall_material].roughness = roughness;
      s.scene.lights.clear();
      const View view = small_view(size.x, size.y);
      const Image dark = render(s.scene, view, "forward");
      for (const float z : {-5.0f, -4.5f, -8.0f, -100.0f})
        add_point(s.scene, "behind", {0, 0, z}, {1, 1, 1}, 100, 1000);
      const Image forward = render(s.scene, view, "forward");
      EXPECT_EQ(count_nan_pixels(forward), 0u);
      EXPECT_TRUE(identical(forward, dark));
      expect_exact(s.scene, view, {}, forward);
    }
  }
}

TEST(ForwardPlus, ASceneOfNothingShowsItsBackground) {
  Scene scene;
  scene.background = {0.25f, 0.5f, 0.75f};
  for (const char* technique : {"forward", "forward_plus"}) {
    for (const bool everything : {false, true}) {
      const Image image = render(scene, small_view(17, 9), technique, {{setting::everything_on, everything}});
      for (const glm::vec4& pixel : image.pixels) ASSERT_EQ(glm::vec3(pixel), scene.background) << technique;
    }
  }
}

}  // namespace
}  // namespace lightgrid
