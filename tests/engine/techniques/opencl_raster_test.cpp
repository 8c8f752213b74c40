// raster=opencl: deferred_tiled and forward_plus_compute with triangles and surfaces of OpenCL, against
// visibility, which has the same surfaces and adds the same lights without a geometry buffer.
#include "base/error.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/samples.h"
#include "plan/settings/surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

const Settings opencl{{setting::raster, RasterApi::opencl}};

struct Drawn {
  Image image;
  std::vector<float> depth;
  LitPairs pairs;
  FrameFigures result;
};

Drawn drawn(const char* technique, const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  Drawn d{run.image(), read_depth(run), {}, run.result()};
  d.pairs = count_listed_pairs(run, d.depth);
  run.run_frame();
  EXPECT_TRUE(identical(run.image(), d.image)) << technique << ", the next frame";
  return d;
}

// Lights are the same, and surfaces to the last bit of metalness. What differs is the rounding of the sums:
// visibility's kernel rounds multiply-adds once, shade_tiles twice, and with base lighting the sum of lights
// is added to it, not begun with it. A light's term has about 50 roundings of 2^-24 in either (oracle_test):
// 3e-6 of the brightest channel if all went one way. Measured: 6.7e-7 at most.
constexpr double rounding = 2e-6;

void expect_visibilitys_picture(const Scene& scene, const View& view) {
  const Drawn visibility = drawn("visibility", scene, view, {});
  const Drawn deferred = drawn("deferred_tiled", scene, view, opencl);
  const Drawn forward = drawn("forward_plus_compute", scene, view, opencl);
  EXPECT_TRUE(identical(forward.image, deferred.image)) << "the same passes";
  const double apart = compare_images(deferred.image, visibility.image).max_rel;
  fmt::print("{} {}x{}: {:.2g} of the brightest channel\n", scene.name, view.width, view.height, apart);
  EXPECT_LT(apart, rounding);
  EXPECT_EQ(deferred.depth, visibility.depth);
  EXPECT_EQ(deferred.pairs.listed, visibility.pairs.listed);
  EXPECT_EQ(deferred.pairs.listed_of_pixel, visibility.pairs.listed_of_pixel);
  EXPECT_EQ(deferred.pairs.lost, 0u);
  EXPECT_EQ(deferred.pairs.wrong, 0u);
  EXPECT_EQ(count_nan_pixels(deferred.image), 0u);
}

Scene every_effect() {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  return s.scene;
}

TEST(RasterInOpenCl, IsVisibilitysPictureOfHall) {
  const Scene scene = find_builtin_scene("hall")->make();
  expect_visibilitys_picture(scene, default_view(scene, 160, 90));
}

// Glass, masks and all other effects at once; in a view of odd size, and offset by a fraction of a pixel.
TEST(RasterInOpenCl, IsVisibilitysPictureWithEveryEffect) {
  const Scene scene = every_effect();
  View view = small_view(71, 37);
  expect_visibilitys_picture(scene, view);
  view.clip_from_view[2][0] += 2 * 0.375 / view.width;
  view.clip_from_view[2][1] -= 2 * 0.25 / view.height;
  expect_visibilitys_picture(scene, view);
}

// Ambient light is then added by the light pass, and no image is written before it.
TEST(RasterInOpenCl, IsVisibilitysPictureWithoutBaseLighting) {
  Scene scene = small_scene().scene;
  scene.ambient = {0.03f, 0.02f, 0.04f};
  const View view = small_view(47, 31);
  ASSERT_FALSE(plan_frame(scene, view, {}, find_technique("deferred_tiled").needs).surfaces.base_lighting);
  expect_visibilitys_picture(scene, view);
}

TEST(RasterInOpenCl, InEverySize) {
  const Scene scene = every_effect();
  for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {3, 31}, {129, 70}}) {
    expect_visibilitys_picture(scene, small_view(width, height));
  }
}

TEST(RasterInOpenCl, WithoutLightsIsVisibilitysBytes) {
  const Scene scene = small_scene(false).scene;
  const View view = small_view(71, 37);
  EXPECT_TRUE(identical(render(scene, view, "deferred_tiled", opencl), render(scene, view, "visibility")));
}

TEST(RasterInOpenCl, NoSettingOfTheListsChangesABit) {
  const Scene scene = every_effect();
  const View view = small_view(71, 37);
  const Image image = render(scene, view, "deferred_tiled", opencl);
  for (Settings settings : {Settings{{setting::depth_bounds, DepthBoundsMode::none}},
                            Settings{{setting::texels, TexelLayout::separate}},
                            Settings{{setting::kernel_shape, KernelShape::group}}}) {
    settings.set(setting::raster, RasterApi::opencl);
    EXPECT_TRUE(identical(render(scene, view, "deferred_tiled", settings), image));
  }
}

// Fewer bits show, and fewer yet show more: tests/engine/passes/resolve_gbuffer_test.cpp has the rounding
// itself.
TEST(RasterInOpenCl, BufferBitsTradeAccuracyForBytes) {
  const Scene scene = every_effect();
  const View view = small_view(71, 37);
  const size_t pixels = 71 * 37 + RenderView::spare_pixels;
  const Image visibility = render(scene, view, "visibility");
  double before = 0;
  for (const auto& [bits, bytes] : {std::pair<int, size_t>(32, 64), {16, 32}, {8, 16}}) {
    const Drawn d = drawn("deferred_tiled", scene, view,
                          {{setting::buffer_bits, bits}, {setting::raster, RasterApi::opencl}});
    constexpr size_t surface_number = 1;  // of the surface's mask of light groups
    EXPECT_EQ(d.result.memory_gbuffer, pixels * (bytes + surface_number)) << bits;
    const double apart = compare_images(d.image, visibility).max_rel;
    EXPECT_GT(apart, before) << bits;
    EXPECT_LT(apart, bits == 32 ? rounding : 0.01) << bits;
    before = 10 * apart;
  }
}

TEST(RasterInOpenCl, DrawsTheSameBytesWithoutOpenGl) {
  static Renderer* const opencl_alone =
      new Renderer("", GlBackend::none);  // never closed, as support/devices.h says
  const Scene scene = every_effect();
  const View view = small_view(71, 37);
  for (const char* technique : {"deferred_tiled", "forward_plus_compute"}) {
    for (const int samples : {1, 4}) {
      const Settings of{{setting::raster, RasterApi::opencl}, {setting::samples, samples}};
      EXPECT_TRUE(
          identical(render(*opencl_alone, scene, view, technique, of), render(scene, view, technique, of)))
          << technique << ' ' << samples;
    }
    EXPECT_THROW(TechniqueRun(*opencl_alone, scene, view, {}, find_technique(technique)), Error) << technique;
  }
}

// compare counts the pixels whose triangle is not OpenGL's apart: only of techniques that draw without it.
TEST(RasterInOpenCl, HasSurfacesOfItsOwnOnlyWhereItIsChosen) {
  for (const Technique* technique : techniques()) {
    const std::string name = technique->name;
    const bool chooses = name == "deferred_tiled" || name == "forward_plus_compute" ||
                         name == "light_prepass" || name == "voxel_lights" || name == "world_grid";
    const bool visibility = technique->name == std::string("visibility");
    EXPECT_EQ(own_surfaces(*technique, {}), visibility) << technique->name;
    EXPECT_EQ(own_surfaces(*technique, opencl), chooses || visibility) << technique->name;
    EXPECT_EQ(reads_setting(*technique, "raster"), chooses) << technique->name;
  }
}

}  // namespace
}  // namespace lightgrid
