#include "accuracy/surfaces_in_double.h"

#include <gtest/gtest.h>
#include <numeric>

#include <limits>

#include "compare/compare.h"
#include "plan/settings/surfaces.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

// Differences of 0.5 and -1 in one channel each: 1.5 of 2 remain of 2.5, and 4 is the brightest channel.
TEST(SurfacesError, WorkedByHand) {
  Image image(3, 1);
  image.pixels = {{1, 0.5f, 0, 1}, {9, 9, 9, 1}, {0, 0, 0.5f, 1}};
  const SurfacesInDouble in_double{{0, 2}, {{1, 0, 0}, {0, 0, 1.5}}};
  const SurfacesError e = surfaces_error(image, in_double, 4);
  EXPECT_EQ(e.pixels, 2u);
  EXPECT_DOUBLE_EQ(e.sum_rel, 2 / 2.5 - 1);
  EXPECT_DOUBLE_EQ(e.max_rel, 0.25);
  EXPECT_DOUBLE_EQ(e.p99_rel, 0.25);
  EXPECT_DOUBLE_EQ(e.rmse_rel, std::sqrt(1.25 / 6) / 4);
  image.pixels[0].g = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(surfaces_error(image, in_double, 4).max_rel, std::numeric_limits<double>::infinity());
  EXPECT_EQ(surfaces_error(image, {}, 4).pixels, 0u);
}

SmallScene textured() {
  SmallScene s = small_scene();
  for (const char* name : {"base_color_map", "normal_map", "metallic_roughness_map"}) effect(name).add(s);
  Material& wall = s.scene.materials[s.wall_material];
  wall.normal_scale = 3;
  wall.normal_map.uv_from_vertex = {6, 0, 0, 6, 0, 0};  // minified
  return s;
}

CompareReport compared(const Scene& scene, const View& view) {
  const Technique& deferred = find_technique("deferred");
  return compare_techniques(software_devices(), scene, view,
                            {{&find_technique("forward"), {}},
                             {&find_technique("visibility"), {}},
                             {&deferred, {{setting::buffer_bits, 8}}}},
                            {.frames = 1, .warmup = 0, .shaded_samples = 3000});
}

TEST(SurfacesError, OfCompareTellsWhoseSurfacesAreNear) {
  const CompareReport report = compared(textured().scene, small_view(131, 77));
  ASSERT_TRUE(report.reference_surfaces);
  const SurfacesError &forward = *report.rows[0].error->surfaces,
                      &visibility = *report.rows[1].error->surfaces,
                      &deferred = *report.rows[2].error->surfaces;
  EXPECT_EQ(forward.rmse_rel, report.reference_surfaces->rmse_rel);
  EXPECT_EQ(forward.pixels, deferred.pixels);
  EXPECT_GT(forward.pixels, 2000u);
  EXPECT_LT(visibility.rmse_rel, 1e-4);
  EXPECT_LT(forward.rmse_rel, 1e-4);
  EXPECT_LT(std::abs(forward.sum_rel), 5e-4);
  EXPECT_GT(deferred.rmse_rel, 5 * forward.rmse_rel) << "a normal in 8 bits";
}

// The judge itself: with another scale of the normal map it finds other surfaces.
TEST(SurfacesInDouble, AreOfTheScene) {
  SmallScene s = textured();
  const View view = small_view(95, 53);
  TechniqueRun forward(software_devices(), s.scene, view, {}, find_technique("forward"));
  forward.run_frame();
  const std::vector<SceneTriangle> shown = read_triangles(forward.view()).opaque;
  std::vector<uint32_t> pixels(shown.size());
  std::iota(pixels.begin(), pixels.end(), 0u);
  const auto error = [&](double normal_scale) {
    s.scene.materials[s.wall_material].normal_scale = float(normal_scale);
    return surfaces_error(forward.image(), surfaces_in_double(forward.view(), shown, pixels), 1);
  };
  EXPECT_GT(error(3.3).rmse_rel, 10 * error(3).rmse_rel);
  EXPECT_LT(error(3).pixels, pixels.size()) << "the background is left out";
}

}  // namespace
}  // namespace lightgrid::lab
