// Pixels that show another triangle than OpenGL's, and the difference elsewhere.
#include "accuracy/surfaces_in_double.h"

#include <gtest/gtest.h>

#include <array>

#include "compare/compare.h"
#include "measures/metrics.h"
#include "passes/light_index/lidr_settings.h"
#include "plan/settings/surfaces.h"
#include "support/devices.h"
#include "support/double_surfaces.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

// Three pixels of 2 x 2: another triangle, a neighbour of glass, and 0.5 of 4 apart.
TEST(SilhouetteErrors, WorkedByHand) {
  const SceneTriangle a{0, {1, 2, 3}}, b{0, {2, 3, 4}}, nothing;
  Image reference(5, 1), image(5, 1);
  reference.pixels = {{4, 0, 0, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}};
  image.pixels = {{4, 0, 0.5f, 1}, {1, 3, 1, 1}, {1, 1, 1, 1}, {9, 0, 0, 1}, {0, 0, 0, 1}};
  const ShownTriangles shown{{a, a, nothing, a, a}, {false, false, false, false, true}};
  const SilhouetteError e = silhouette_error(image, {a, b, nothing, a, a}, reference, shown);
  EXPECT_EQ(e.silhouettes, 1u);
  EXPECT_EQ(e.blended, 2u);
  EXPECT_EQ(e.inside, 2u);
  EXPECT_DOUBLE_EQ(e.max_rel, 0.5 / 4);
  EXPECT_DOUBLE_EQ(e.rmse_rel, std::sqrt(0.25 / 6) / 4);
  EXPECT_DOUBLE_EQ(e.p99_rel, 0.5 / 4);
}

std::vector<SceneTriangle> in_double(const Scene& scene, const View& view,
                                     const std::vector<int>& instances) {
  const double_surfaces::Surfaces surfaces(scene, view, instances);
  std::vector<SceneTriangle> triangles;
  for (const double_surfaces::Hit& hit : surfaces.hits()) {
    if (hit.instance < 0) {
      triangles.emplace_back();
      continue;
    }
    const std::vector<uint32_t>& indices = scene.meshes[scene.instances[hit.instance].mesh].indices;
    triangles.push_back(scene_triangle(hit.instance, &indices[3 * hit.triangle]));
  }
  return triangles;
}

size_t differing(const std::vector<SceneTriangle>& a, const std::vector<SceneTriangle>& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

TEST(SilhouetteErrors, BothRasterisersTrianglesAreThoseInDouble) {
  SmallScene s = small_scene();
  effect("mask").add(s);
  const View view = small_view(131, 77);
  TechniqueRun visibility(software_devices(), s.scene, view, {}, find_technique("visibility"));
  TechniqueRun forward(software_devices(), s.scene, view, {}, find_technique("forward"));
  visibility.run_frame();
  forward.run_frame();
  const auto expected = in_double(s.scene, view, visibility.view().plan.surfaces.opaque);
  const auto own = own_triangles(visibility);
  const ShownTriangles shown = read_triangles(forward.view());
  EXPECT_LT(differing(own, expected), expected.size() / 200);
  EXPECT_LT(differing(shown.opaque, expected), expected.size() / 200);
  EXPECT_EQ(std::ranges::count(shown.blended, true), 0);
}

// A leaf of two triangles of the same corners, back to back: which of them a pixel shows decides its colour.
Scene leaf(bool front, bool back) {
  SmallScene s = small_scene();
  Mesh mesh;
  mesh.positions = {{-1, -0.8f, -2}, {1, -0.8f, -2}, {0, 0.9f, -2}};
  mesh.normals.assign(3, {0, 0, 1});
  if (front) mesh.indices.insert(mesh.indices.end(), {1, 2, 0});
  if (back) mesh.indices.insert(mesh.indices.end(), {1, 0, 2});
  s.scene.materials[s.wall_material].double_sided = true;
  add_instance(s.scene, "leaf",
               add_mesh(s.scene, shapes::finished(std::move(mesh), "leaf", s.wall_material)));
  return s.scene;
}

TEST(SilhouetteErrors, TrianglesBackToBackAreTwo) {
  EXPECT_EQ(scene_triangle(3, std::array{7u, 5u, 6u}.data()), (SceneTriangle{3, {5, 6, 7}}));
  EXPECT_EQ(scene_triangle(3, std::array{6u, 5u, 7u}.data()), (SceneTriangle{3, {5, 7, 6}}));
  const View view = small_view(60, 40);
  std::vector<SceneTriangle> at_the_middle;
  for (const bool front : {true, false}) {
    const Scene scene = leaf(front, !front);
    TechniqueRun visibility(software_devices(), scene, view, {}, find_technique("visibility"));
    TechniqueRun forward(software_devices(), scene, view, {}, find_technique("forward"));
    visibility.run_frame();
    forward.run_frame();
    const size_t middle = 20 * 60 + 30;
    at_the_middle.push_back(own_triangles(visibility)[middle]);
    EXPECT_EQ(read_triangles(forward.view()).opaque[middle], at_the_middle.back()) << front;
  }
  EXPECT_EQ(at_the_middle[0], (SceneTriangle{2, {0, 1, 2}}));
  EXPECT_EQ(at_the_middle[1], (SceneTriangle{2, {0, 2, 1}}));
}

// Whichever of the two is shown, a pixel that differs because of it is no pixel inside.
TEST(SilhouetteErrors, APixelWithTheOtherSideOfALeafIsNotInside) {
  const CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  const CompareReport report = compare_techniques(
      software_devices(), leaf(true, true), small_view(131, 77),
      {{&find_technique("forward_plus"), {}}, {&find_technique("visibility"), {}}}, options);
  ASSERT_TRUE(report.rows[1].error->silhouettes.has_value());
  EXPECT_GT(report.rows[1].error->silhouettes->inside, 131u * 77u / 2);
  EXPECT_LT(report.rows[1].error->silhouettes->max_rel, 1e-3);
}

TEST(SilhouetteErrors, AreCountedApartByCompare) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  const CompareReport report =
      compare_techniques(software_devices(), s.scene, small_view(131, 77),
                         {{&find_technique("forward_plus"), {}},
                          {&find_technique("visibility"), {}},
                          {&find_technique("deferred_tiled"), {}},
                          {&find_technique("deferred_tiled"), {{setting::raster, RasterApi::opencl}}}},
                         options);
  EXPECT_FALSE(report.rows[2].error->silhouettes.has_value());
  ASSERT_TRUE(report.rows[3].error->silhouettes.has_value());
  EXPECT_EQ(report.rows[3].error->silhouettes->silhouettes, report.rows[1].error->silhouettes->silhouettes);
  EXPECT_FALSE(report.rows[0].error->silhouettes.has_value());
  const std::optional<SilhouetteError>& apart = report.rows[1].error->silhouettes;
  ASSERT_TRUE(apart.has_value());
  EXPECT_EQ(apart->silhouettes + apart->blended + apart->inside, 131u * 77u);
  EXPECT_GT(apart->blended, 100u);
  EXPECT_LT(apart->silhouettes, 131u * 77u / 100u);
  EXPECT_LT(apart->max_rel, 1e-3);
  EXPECT_LE(apart->max_rel, report.rows[1].error->max_rel);
}

// visibility's picture is not forward's, and yet every light's on its own surfaces.
TEST(SameSurfaces, JudgeTheLightOfATechniqueApartFromItsSurfaces) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask"}) effect(name).add(s);
  CompareOptions options{.frames = 1, .warmup = 0, .shaded_samples = 10};
  const std::vector<Contestant> contestants = {
      {&find_technique("forward_plus"), {}},
      {&find_technique("visibility"), {}},
      {&find_technique("deferred_tiled"), {{setting::raster, RasterApi::opencl}}},
      {&find_technique("lidr"), {{setting::lidr_overlap, 1}}}};
  const View view = small_view(131, 77);
  const CompareReport report = compare_techniques(software_devices(), s.scene, view, contestants, options);
  ASSERT_TRUE(report.own_surfaces && report.own_surfaces->error);
  const ImageError& surfaces = *report.own_surfaces->error;
  EXPECT_FALSE(surfaces.bit_identical);
  EXPECT_TRUE(surfaces.silhouettes && surfaces.surfaces && surfaces.displayed);
  EXPECT_GT(report.covered_pixels, 131u * 77u / 4);
  EXPECT_LT(report.covered_pixels, 131u * 77u);
  EXPECT_NEAR(report.brightest, surfaces.max_abs / surfaces.max_rel, 1e-4 * report.brightest);
  const std::vector<RunResult>& rows = report.rows;
  EXPECT_EQ(light_error(rows[0]), &*rows[0].error);
  ASSERT_TRUE(light_error(rows[1]) && light_error(rows[2]));
  EXPECT_TRUE(light_error(rows[1])->bit_identical);
  EXPECT_EQ(light_error(rows[1])->displayed->mean, 0);
  EXPECT_EQ(rows[1].error->max_rel, surfaces.max_rel);
  EXPECT_LT(light_error(rows[2])->max_rel, 1e-5);
  EXPECT_GT(light_error(rows[3])->displayed->visible, 0) << "one light a pixel";

  options.reference = ReferencePixels::sampled;
  const CompareReport sampled = compare_techniques(software_devices(), s.scene, view, contestants, options);
  ASSERT_TRUE(sampled.own_surfaces.has_value());
  EXPECT_FALSE(sampled.own_surfaces->error.has_value());
  EXPECT_EQ(sampled.own_surfaces->why_not, "the reference is a sample");
  EXPECT_EQ(light_error(sampled.rows[1]), nullptr);
}

}  // namespace
}  // namespace lightgrid::lab
