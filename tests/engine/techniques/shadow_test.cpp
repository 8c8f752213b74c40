// Shadows in every technique's picture: each pair of a pixel and a light against the oracle, and radiance in
// double.
#include "accuracy/oracle_sample.h"
#include "oracle/position.h"
#include "plan/settings/surfaces.h"
#include "scene/rig.h"
#include "techniques/lidr_scenes.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr int shadow_width = 93, shadow_height = 55;  // tiles of all sizes are cut

Scene hall_of_casters() {
  Scene scene = find_builtin_scene("hall")->make();
  for (Light& light : scene.lights) light.casts_shadow = true;
  return scene;
}

// The first picture of each rasteriser is compared with radiance in double; the others with it.
struct Pictures : ShadowStage {
  TechniqueRun forward{test_devices(), gpu, view, {}, find_technique("forward")},
      visibility{test_devices(), gpu, view, {}, find_technique("visibility")};
  TechniqueRun& first(bool own_surfaces) { return own_surfaces ? visibility : forward; }
};

Pictures& pictures_of(const std::string& name) {
  static std::map<std::string, Pictures*> made;
  Pictures*& pictures = made[name];
  if (!pictures) {
    const Scene scene = name == "hall" ? hall_of_casters() : shadowed_scene();
    pictures = new Pictures{{scene, name == "hall" ? default_view(scene, shadow_width, shadow_height)
                                                   : small_view(shadow_width, shadow_height)}};
    pictures->forward.run_frame();
    pictures->visibility.run_frame();
  }
  return *pictures;
}

struct Shadows : testing::TestWithParam<ShadowWay> {};

// Sums are in forward's order.
bool sums_as_forward(const std::string& name) {
  return name == "forward" || name == "forward_plus" || name == "clustered" || name == "world_grid";
}

TEST_P(Shadows, AreTheOraclesInEachPairAndInThePicture) {
  const auto [technique, raster] = GetParam();
  const Settings settings{{setting::raster, raster}};
  const bool own = own_surfaces(*technique, settings);
  for (const char* name : {"small", "hall"}) {
    if (technique->limited_lists && std::string(name) == "hall") continue;  // it has places for few lights
    SCOPED_TRACE(name);
    Pictures& pictures = pictures_of(name);
    TechniqueRun run(test_devices(), pictures.gpu, pictures.view, settings, *technique);
    run.run_frame();
    EXPECT_TRUE(exact(pictures.pairs(run)));
    if (technique->approximate) continue;  // another picture: ShadowsInTiles
    const Image& first = pictures.first(own).image();
    if (!own && sums_as_forward(technique->name)) {
      EXPECT_TRUE(identical(run.image(), first));
    } else {
      EXPECT_LT(compare_images(run.image(), first).max_rel, other_order);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Shadows, testing::ValuesIn(shadow_ways()), [](const auto& info) {
  return info.param.technique->name + std::string(info.param.raster == RasterApi::opencl ? "_opencl" : "");
});

// The largest error of a colour channel, over the pixel's own in double: a light too much or too few is seen
// in dark pixels too.
double worst(const Image& image, const std::vector<uint32_t>& pixels,
             const std::vector<glm::dvec3>& radiance) {
  double most = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      most = std::max(most, std::abs(double(image.pixels[pixels[i]][c]) - radiance[i][c]) / radiance[i][c]);
  }
  return most;
}

// Measured: 2.5e-6 and 4.7e-5.
TEST(ShadowPicture, OfOpenGlsSurfacesIsTheOraclesInDouble) {
  for (const char* name : {"small", "hall"}) {
    Pictures& pictures = pictures_of(name);
    const std::vector<float> depth = read_depth(pictures.forward);
    const SurfaceOracle oracle(pictures.forward.view(), depth, &pictures.truth);
    const std::vector<uint32_t> pixels = oracle.decided(oracle.pixels());
    EXPECT_GT(pixels.size(), shadow_width * shadow_height / 3);
    EXPECT_LT(worst(pictures.forward.image(), pixels, oracle.shade(pixels, true)), 2e-4) << name;
  }
}

// Its own surfaces, in double but for depth, which decides where a shadow ends. Measured: 2.4e-3, with
// shadows and without, at the ball's edge, where a pixel's place in its triangle is rounded most.
TEST(ShadowPicture, OfSurfacesDrawnInOpenClIsTheOraclesInDouble) {
  Pictures& pictures = pictures_of("small");
  TechniqueRun& run = pictures.visibility;
  const std::vector<float> depth = read_depth(run);
  const std::vector<SceneTriangle> shown = own_triangles(run);
  std::vector<uint32_t> pixels = surfaces_in_double(run.view(), shown, covered_pixels(depth)).pixels;
  const ShownTriangles in_gl = read_triangles(pictures.forward.view());
  std::erase_if(pixels, [&](uint32_t pixel) { return in_gl.blended[pixel]; });
  const auto seen =
      pictures.truth.at_pixels(run.view(), depth, casting_triangles(pictures.scene, shown), pixels);
  std::erase_if(pixels, [&](uint32_t pixel) { return seen->has_either(pixel); });
  EXPECT_GT(pixels.size(), shadow_width * shadow_height / 3);
  SceneSurfaces surfaces(pictures.scene, pictures.view);
  std::map<uint32_t, Surface> at;
  for (const uint32_t pixel : pixels) {
    const glm::dvec2 centre(pixel % shadow_width + 0.5, pixel / shadow_width + 0.5);
    at[pixel] = surfaces.surface_at(surfaces.triangle(shown[pixel].instance, shown[pixel].vertices), centre);
  }
  const std::vector<glm::dvec3> radiance = shade_pixels(
      pictures.view, depth, [&](uint32_t pixel) { return at.at(pixel); },
      lights_in_view(pictures.scene, pictures.view),
      {.ambient = pictures.scene.ambient, .hidden = seen->hidden()}, pixels);
  EXPECT_LT(worst(run.image(), pixels, radiance), 5e-3);
}

TEST(ShadowPicture, ShowsShadows) {
  for (const char* name : {"small", "hall"}) {
    Pictures& pictures = pictures_of(name);
    TechniqueRun& run = pictures.forward;
    Scene bare = pictures.scene;
    for (Light& light : bare.lights) light.casts_shadow = false;
    const Image lit = render(bare, pictures.view, "forward");
    size_t darker = 0, lighter = 0;
    for (size_t i = 0; i < lit.pixels.size(); ++i) {
      darker += run.image().pixels[i].g < 0.9f * lit.pixels[i].g;
      lighter += run.image().pixels[i].g > lit.pixels[i].g;
    }
    EXPECT_GT(darker, lit.pixels.size() / 10) << name;
    EXPECT_EQ(lighter, 0u) << name;
    const LitPairs pairs = pictures.pairs(run);
    EXPECT_LT(double(pairs.either), 0.02 * double(pairs.lit)) << name;
  }
}

// voxel_lights adds lights up where no pixel asks for one: all of them count as seen.
TEST(ShadowPicture, OfVoxelLightsHasNone) {
  Pictures& pictures = pictures_of("small");
  TechniqueRun run(test_devices(), pictures.gpu, pictures.view, {}, find_technique("voxel_lights"));
  run.run_frame();
  EXPECT_FALSE(run.frame().shadows);
  EXPECT_FALSE(run.view().plan.shadows.light_reaches);
  EXPECT_GT(pictures.pairs(run).leaked, 1000u);
}

// settings: KEY=VALUE each.
std::unique_ptr<TechniqueRun> shadowed_run(const char* technique, const std::vector<std::string>& settings,
                                           const char* scene = "small") {
  Pictures& pictures = pictures_of(scene);
  Settings chosen;
  for (const std::string& setting : settings) apply_setting(chosen, setting);
  auto run = std::make_unique<TechniqueRun>(test_devices(), pictures.gpu, pictures.view, chosen,
                                            find_technique(technique));
  run->run_frame();
  return run;
}

// Kernels read the bits of 16 pixels in a square (visibility, light_prepass), in two rows (deferred_tiled in
// tiles of 8) or in one row. Light volumes read them in OpenGL.
struct ShadowsInTiles : testing::TestWithParam<int> {};

TEST_P(ShadowsInTiles, AreReadAlikeInEveryShape) {
  const std::string tile = fmt::format("tile={}", GetParam());
  Pictures& pictures = pictures_of("small");
  EXPECT_LT(compare_images(shadowed_run("deferred_tiled", {tile})->image(), pictures.forward.image()).max_rel,
            other_order);
  EXPECT_TRUE(identical(shadowed_run("visibility", {tile})->image(), pictures.visibility.image()));
  EXPECT_LT(compare_images(shadowed_run("light_prepass", {tile})->image(),
                           shadowed_run("light_prepass", {"prepass-lights=volumes"})->image())
                .max_rel,
            other_order);
}

INSTANTIATE_TEST_SUITE_P(Tiles, ShadowsInTiles, testing::Values(8, 16, 32, 64),
                         [](const auto& info) { return fmt::format("{}", info.param); });

// The kernels for GPUs, whose items take one pixel.
TEST(ShadowBits, AreReadAlikeByAPixelAWorkItem) {
  for (const char* technique : {"deferred_tiled", "light_prepass", "visibility"}) {
    EXPECT_LT(compare_images(shadowed_run(technique, {"kernel-shape=group"})->image(),
                             shadowed_run(technique, {})->image())
                  .max_rel,
              1e-8)
        << technique;
  }
}

// Hundreds of lights take several words a tile.
TEST(ShadowBits, OfHundredsOfLightsAreTheSameInBothFormsOfTheKernel) {
  EXPECT_TRUE(same_bits(shadows_of(*shadowed_run("visibility", {"kernel-shape=group"}, "hall")),
                        shadows_of(pictures_of("hall").visibility)));
  EXPECT_TRUE(identical(shadowed_run("visibility", {"kernel-shape=group"}, "hall")->image(),
                        pictures_of("hall").visibility.image()));
}

// And as many rays.
TEST(ShadowBits, AreTheSameUnderEverySetting) {
  for (const auto& [technique, settings] : std::map<const char*, std::vector<std::string>>{
           {"clustered", {"everything-on=on", "depth-bounds=none", "cull-test=sphere", "slices=4"}},
           {"visibility", {"everything-on=on", "kernel-shape=group", "portable=on", "slices=4"}}}) {
    const auto run = shadowed_run(technique, {});
    const HostShadows shadows = shadows_of(*run);
    const ShadowFigures figures = run->frame().shadow_figures();
    EXPECT_EQ(figures.lights, 7u);
    EXPECT_GT(figures.rays, 1000u);
    for (const std::string& setting : settings) {
      SCOPED_TRACE(technique + (" " + setting));
      const auto other = shadowed_run(technique, {setting});
      EXPECT_TRUE(same_bits(shadows_of(*other), shadows));
      EXPECT_EQ(other->frame().shadow_figures().rays, figures.rays);
      EXPECT_TRUE(identical(other->image(), run->image()));
    }
  }
}

TEST(ShadowBits, AreTheOraclesInAnOrthographicView) {
  Camera camera = look_at({0.3, 0.2, 0}, {0, 0, -4});
  camera.orthographic = true;
  camera.half_width_m = 2;
  camera.half_height_m = 1.2;
  camera.far_m = 20;
  ShadowStage stage{shadowed_scene(), make_view(camera, 61, 37)};
  for (const char* technique : {"forward_plus", "visibility"}) {
    TechniqueRun run(test_devices(), stage.gpu, stage.view, {}, find_technique(technique));
    run.run_frame();
    EXPECT_TRUE(exact(stage.pairs(run))) << technique;
  }
}

TEST(ShadowBits, AreTheOraclesInViewsOfAFewPixels) {
  ShadowStage stage{shadowed_scene(), small_view(1, 1)};
  for (const char* technique : {"forward", "visibility"}) {
    TechniqueRun run(test_devices(), stage.gpu, stage.view, {}, find_technique(technique));
    for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {16, 16}, {3, 31}}) {
      run.look(small_view(width, height));
      run.run_frame();
      const LitPairs pairs = stage.pairs(run);
      EXPECT_EQ(pairs.lost + pairs.wrong + pairs.leaked + pairs.acned, 0u) << width << "x" << height;
      if (width == 17) {
        EXPECT_GT(pairs.lit, 100u);
      }
    }
  }
}

// A run shows the same after a change as a run that begins with it.
TEST(ShadowBits, FollowEveryChange) {
  for (const auto& [technique, reuse] :
       {std::pair("forward_plus", "on"), {"visibility", "off"}, {"visibility", "on"}}) {
    SCOPED_TRACE(fmt::format("{}, shadow-reuse={}", technique, reuse));
    ShadowStage stage{shadowed_scene(), small_view(61, 37)};
    Settings settings;
    apply_setting(settings, std::string("shadow-reuse=") + reuse);
    const int fence = stage.scene.instances[2].mesh;
    auto rig = std::make_shared<Rig>();
    rig->meshes.push_back({.mesh = fence});
    stage.scene.rig = rig;
    TechniqueRun run(test_devices(), stage.gpu, stage.view, settings, find_technique(technique));
    run.run_frame();
    HostShadows before = shadows_of(run);
    const auto expect_new = [&](const char* change, bool differs = true) {
      run.run_frame();
      TechniqueRun own(test_devices(), stage.scene, run.view().view, {}, find_technique(technique));
      own.run_frame();
      HostShadows shadows = shadows_of(run);
      EXPECT_TRUE(same_bits(shadows, shadows_of(own))) << change;
      EXPECT_TRUE(identical(run.image(), own.image())) << change;
      EXPECT_EQ(same_bits(shadows, before), !differs) << change;
      EXPECT_GT(run.frame().shadow_figures().rays, reuse == std::string("on") ? 20u : 500u) << change;
      before = std::move(shadows);
    };
    const auto changed = [&](const SceneChanges& changes) {
      stage.gpu.update(changes);
      run.look(run.view().view, changes);
    };
    stage.scene.lights[2].position += glm::dvec3(0.2, 0.1, 0);
    changed({.lights = {2}});
    expect_new("a light moved");
    stage.scene.instances[1].world_from_object = placed({-0.4, 0.3, -3.1});
    changed({.instances = {1}});
    expect_new("an instance moved");
    Mesh& mesh = stage.scene.meshes[size_t(fence)];
    mesh.bounds = {};
    for (glm::vec3& p : mesh.positions) {
      p.x *= 1.4f;
      p.z += 0.2f * p.y;
      mesh.bounds.add(p);
    }
    changed({.meshes = {fence}});
    expect_new("a mesh deformed");
    run.look(make_view(look_at({0.5, 0.3, 0.2}, {0, 0, -4}), 61, 37));
    expect_new("the camera moved");
    run.look(small_view(83, 50));
    expect_new("the view has another size");
    run.release();
    expect_new("everything was freed", false);
    run.prepare();
    expect_new("everything was built in advance", false);
  }
}

// Loops over more lights than llvmpipe's end after find each light's own bits.
TEST(ShadowBits, OfLightsBehindManyOthers) {
  const View view = small_view(32, 24);
  Scene scene = shadowed_scene();
  const auto lamps = scene.lights;
  const Image few = render(scene, view, "forward");
  scene.lights.clear();
  for (int i = 0; i < 70000; ++i)
    add_point(scene, "spark", {0.001f * float(i % 100) - 0.05f, 0.001f * float(i / 100 % 100) - 0.05f, -1},
              {1, 1, 1}, 1, 1e-3f)
        .casts_shadow = i % 2;
  scene.lights.insert(scene.lights.end(), lamps.begin(), lamps.end());
  EXPECT_TRUE(identical(render(scene, view, "forward"), few));
  EXPECT_TRUE(identical(render(scene, view, "forward_plus"), few));
}

}  // namespace
}  // namespace lightgrid
