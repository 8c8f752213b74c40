// visibility: its image near forward's, its lists against every light, and no further from surfaces in double
// than forward.
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/surfaces.h"
#include "support/double_surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

TEST(VisibilityBuffer, IsNearForwardOnEveryBuiltinScene) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.large) continue;
    SCOPED_TRACE(builtin.name);
    const Scene scene = builtin.make();
    const View view = default_view(scene, 160, 90);
    expect_close(scene, view, {}, render(scene, view, "forward"), "visibility");
  }
}

// Maps, normals and factors of coats are sampled by other code in OpenCL, which passes/resolve_test compares
// with doubles.
TEST(VisibilityBuffer, IsNearForwardUnderCoats) {
  SmallScene s = small_scene();
  effect("clearcoat_maps").add(s);
  s.scene.instances.resize(1);                                               // the wall
  s.scene.materials[s.wall_material].base_color = {0.01f, 0.01f, 0.01f, 1};  // little but the coat is seen
  const View view = small_view(90, 90);
  const ImageDistance distance =
      distance_of(render(s.scene, view, "visibility"), render(s.scene, view, "forward"));
  // Measured: 3 pixels at the edges. With the roughness from another channel 1.3 %, with another normal scale
  // 7 %.
  EXPECT_LT(distance.share_apart, 0.003);
}

TEST(VisibilityBuffer, ListsAndEveryLightHaveTheSameBytes) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.large) continue;
    SCOPED_TRACE(builtin.name);
    const Scene scene = builtin.make();
    const View view = default_view(scene, 95, 53);
    const Image all = render(scene, view, "visibility", {{setting::lights, ShadedLights::all}});
    EXPECT_TRUE(identical(render(scene, view, "visibility"), all));
    if (builtin.name != std::string("hall"))
      continue;  // with every effect; each setting is a kernel to compile
    for (const Settings& settings : {Settings{{setting::tile, 8}, {setting::everything_on, true}},
                                     Settings{{setting::z_bins, 64}, {setting::everything_on, true}},
                                     Settings{{setting::depth_bounds, DepthBoundsMode::none}}}) {
      EXPECT_TRUE(identical(render(scene, view, "visibility", settings), all));
    }
  }
}

// A slice's list serves the pixels in it: fewer lights listed, the same bytes. hall has glass.
TEST(VisibilityBuffer, SlicesHaveTheSameBytesAndListLess) {
  const Scene scene = find_builtin_scene("hall")->make();
  const View view = default_view(scene, 95, 53);
  const Image all = render(scene, view, "visibility", {{setting::lights, ShadedLights::all}});
  uint64_t listed[2];
  const Settings of[2] = {{}, Settings{{setting::slices, 16}}.give(setting::slices)};
  for (int i = 0; i < 2; ++i) {
    TechniqueRun run(test_devices(), scene, view, of[i], find_technique("visibility"));
    run.run_frame();
    EXPECT_EQ(run.frame().grid->slices, i == 0 ? 1 : 16);
    EXPECT_TRUE(identical(run.image(), all)) << i;
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    EXPECT_EQ(pairs.lost, 0u);
    EXPECT_EQ(pairs.wrong, 0u);
    listed[i] = pairs.listed;
  }
  EXPECT_LT(double(listed[1]), 0.9 * double(listed[0]));
}

TEST(VisibilityBuffer, InEverySize) {
  const Scene scene = find_builtin_scene("spheres")->make();
  for (const auto& [width, height] : {std::pair(1, 1), {17, 9}, {3, 31}, {129, 70}}) {
    const View view = default_view(scene, width, height);
    const Image image = render(scene, view, "visibility");
    EXPECT_TRUE(identical(render(scene, view, "visibility", {{setting::lights, ShadedLights::all}}), image))
        << width;
    EXPECT_LT(distance_of(image, render(scene, view, "forward")).median, 1e-3) << width;
  }
}

// Panes over one another and over the ball, one of them in front of the wall alone.
TEST(VisibilityBuffer, LaysBlendedSurfacesOverOneAnotherInForwardsOrder) {
  SmallScene s = small_scene();
  for (int i = 0; i < 3; ++i) {
    const int glass =
        add_material(s.scene, "glass", {0.9f - 0.3f * float(i), 0.3f, 0.2f + 0.3f * float(i)}, 0, 0.3f);
    s.scene.materials[glass].base_color.a = 0.35f + 0.1f * float(i);
    s.scene.materials[glass].alpha_mode = AlphaMode::blend;
    s.scene.materials[glass].double_sided = i == 1;
    const glm::vec3 at{-0.4f + 0.3f * float(i), 0.1f * float(i), -2 - 0.7f * float(i)};
    add_instance(s.scene, "pane", add_mesh(s.scene, wall_mesh(at, 0.7f, glass, "pane")));
  }
  const View view = small_view(127, 73);
  const Image forward = render(s.scene, view, "forward"), image = render(s.scene, view, "visibility");
  const double apart = compare_images(image, forward).rmse;
  expect_near(image, forward);
  EXPECT_TRUE(identical(render(s.scene, view, "visibility", {{setting::lights, ShadedLights::all}}), image));
  s.scene.instances.resize(2);
  EXPECT_GT(compare_images(render(s.scene, view, "visibility"), forward).rmse, 20 * apart) << "glass is seen";
}

// The base colour's alpha, of a material with two maps of one size.
TEST(VisibilityBuffer, BlendsByTheAlphaOfATexture) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  Material& glass = s.scene.materials.back();
  glass.base_color_map.texture = add_speckles(s.scene, true);
  glass.normal_map.texture = add_speckles(s.scene, false);
  const View view = small_view(127, 73);
  const Image image = render(s.scene, view, "visibility");
  expect_near(image, render(s.scene, view, "forward"));
  EXPECT_LT(
      compare_images(image, render(s.scene, view, "visibility", {{setting::texels, TexelLayout::separate}}))
          .max_rel,
      1e-5);
}

struct Distances {
  double visibility = 0, forward = 0;
  size_t pixels = 0;
};

// Mean errors against surfaces in double, at pixels in the inside of a triangle, where all agree on what is
// seen.
Distances distances_from_double(const Scene& scene, const View& view) {
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("visibility"));
  run.run_frame();
  const Image forward = render(scene, view, "forward");
  const std::vector<float> depth = read_depth(run);
  double_surfaces::Surfaces surfaces(scene, view, run.view().plan.surfaces.opaque);
  const auto& hits = surfaces.hits();
  std::vector<uint32_t> inside;
  for (int y = 1; y + 1 < view.height; ++y) {
    for (int x = 1; x + 1 < view.width; ++x) {
      const uint32_t at = uint32_t(y * view.width + x);
      bool same = hits[at].instance >= 0;
      for (const int step : {-1, 1, -view.width, view.width}) {
        same = same && hits[at + step].instance == hits[at].instance &&
               hits[at + step].triangle == hits[at].triangle;
      }
      if (same) inside.push_back(at);
    }
  }
  std::map<uint32_t, Surface> seen;
  for (const uint32_t pixel : inside) seen[pixel] = surfaces.surface_at(pixel);
  const auto radiance = shade_pixels(
      view, depth, [&](uint32_t pixel) { return seen.at(pixel); }, lights_in_view(scene, view),
      {.ambient = scene.ambient}, inside);
  Distances d{.pixels = inside.size()};
  for (size_t i = 0; i < inside.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      d.visibility += std::abs(double(run.image().pixels[inside[i]][c]) - radiance[i][c]);
      d.forward += std::abs(double(forward.pixels[inside[i]][c]) - radiance[i][c]);
    }
  }
  return d;
}

TEST(VisibilityBuffer, IsNoFurtherFromSurfacesInDoubleThanForward) {
  for (const char* name : {"hall", "street"}) {
    Scene scene = find_builtin_scene(name)->make();
    for (Material& m : scene.materials) {
      if (m.alpha_mode == AlphaMode::blend) m.alpha_mode = AlphaMode::opaque;
    }
    const Distances d = distances_from_double(scene, default_view(scene, 160, 90));
    EXPECT_GT(d.pixels, 1000u) << name;
    EXPECT_LE(d.visibility, d.forward) << name;
    fmt::print("{}: mean error {:.3g}, forward's {:.3g}, of {} pixels\n", name,
               d.visibility / double(3 * d.pixels), d.forward / double(3 * d.pixels), d.pixels);
  }
}

}  // namespace
}  // namespace lightgrid
