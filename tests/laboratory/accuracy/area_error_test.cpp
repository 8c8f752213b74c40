#include "accuracy/area_error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compare/compare.h"
#include "plan/settings/samples.h"
#include "support/devices.h"
#include "support/fine_truth.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

TEST(AreaError, WorkedByHand) {
  Image image(4, 1);
  image.pixels = {{1, 0.5f, 0, 1}, {9, 9, 9, 1}, {0, 0, 5, 1}, {2, 0, 0, 1}};
  AreaTruth truth{{0, 2, 3},
                  {{.radiance = {0.5, 0.5, 0}, .at_edge = true},
                   {.radiance = {0, 0, 4}, .at_edge = true},
                   {.radiance = {2, 0, 0.25}}}};
  const AreaError e = area_error(image, truth, 4, 2);
  EXPECT_EQ(e.edges.pixels, 2u);
  EXPECT_EQ(e.inside.pixels, 1u);
  EXPECT_DOUBLE_EQ(e.edges.max_rel, 1.0 / 4);
  EXPECT_DOUBLE_EQ(e.edges.rmse_rel, std::sqrt((0.25 + 1) / 6) / 4);
  EXPECT_DOUBLE_EQ(e.edges.rmse_shown, std::sqrt(0.25 / 6) / 2);  // 4 and 5 are both white
  EXPECT_DOUBLE_EQ(e.inside.rmse_rel, std::sqrt(0.0625 / 3) / 4);
  image.pixels[3].g = NAN;
  EXPECT_EQ(area_error(image, truth, 4, 2).inside.max_rel, INFINITY);
  EXPECT_EQ(area_error(image, {}, 4, 2).edges.pixels, 0u);
}

// Edges are silhouettes alone: masks and blended surfaces cover pixels by their centres, and a lamp near the
// ball lights a spot of less than a pixel.
SmallScene in_the_sun() {
  SmallScene s = small_scene(false);
  effect("directional").add(s);
  for (Material& m : s.scene.materials) {
    m.metallic = 0;
    m.roughness = 1;
  }
  return s;
}

CompareReport compared_samples(const Scene& scene, const std::vector<int>& samples) {
  std::vector<Contestant> contestants;
  for (const int n : samples) contestants.push_back({&find_technique("visibility"), {{setting::samples, n}}});
  return compare_techniques(software_devices(), scene, small_view(67, 41), contestants,
                            {.frames = 1, .warmup = 0, .shaded_samples = 100});
}

// Rows are those of the setting; the reference has one sample a pixel, whatever the scene asks for.
TEST(AreaError, OfRowsWhoseSceneAsksForSamples) {
  Scene scene = in_the_sun().scene;
  const std::vector<Contestant> plain = {{&find_technique("forward"), {{setting::samples, 4}}},
                                         {&find_technique("visibility"), {{setting::samples, 4}}},
                                         {&find_technique("visibility"), {}}};
  const std::vector<Contestant> of_scene = {{&find_technique("forward"), {}},
                                            {&find_technique("visibility"), {}},
                                            {&find_technique("visibility"), with_samples({}, 1)}};
  const auto compared = [&](const std::vector<Contestant>& contestants) {
    return compare_techniques(software_devices(), scene, small_view(33, 17), contestants,
                              {.frames = 1, .warmup = 0, .shaded_samples = 100});
  };
  const CompareReport given = compared(plain);
  scene.samples = 4;
  const CompareReport asked = compared(of_scene);
  EXPECT_EQ(asked.reference_image.pixels, given.reference_image.pixels);
  for (size_t i = 0; i < given.rows.size(); ++i) {
    const RunResult &a = given.rows[i], &b = asked.rows[i];
    ASSERT_TRUE(a.error && b.error && a.error->area && b.error->area) << i << b.refused;
    EXPECT_EQ(a.settings, b.settings);
    EXPECT_EQ(a.error->rmse, b.error->rmse) << i;
    EXPECT_EQ(a.error->area->edges.rmse_rel, b.error->area->edges.rmse_rel) << i;
    EXPECT_EQ(a.same_surfaces.has_value(), b.same_surfaces.has_value()) << i;
    if (a.same_surfaces && b.same_surfaces) {
      EXPECT_EQ(a.same_surfaces->rmse, b.same_surfaces->rmse) << i;
    }
  }
}

// With random places errors at edges would fall by the square root of 2 per step: a slope of -0.5.
TEST(AreaError, OfCompareFallsAtEdgesAndIsSmallInside) {
  const CompareReport report = compared_samples(in_the_sun().scene, {1, 2, 4, 8});
  std::vector<AreaError> of;
  for (const RunResult& row : report.rows) {
    ASSERT_TRUE(row.error && row.error->area) << row.refused;
    of.push_back(*row.error->area);
    RecordProperty(
        fmt::format("samples_{}", 1 << (of.size() - 1)),
        fmt::format("edges {:.5f}, inside {:.6f}", of.back().edges.rmse_rel, of.back().inside.rmse_rel));
  }
  EXPECT_GT(of[0].edges.pixels, 100u);
  EXPECT_GT(of[0].inside.pixels, 300u);
  for (size_t i = 1; i < of.size(); ++i) {
    EXPECT_EQ(of[i].edges.pixels, of[0].edges.pixels);
    EXPECT_LT(of[i].edges.rmse_rel, of[i - 1].edges.rmse_rel / std::sqrt(2.0)) << i;
    EXPECT_LT(of[i].edges.rmse_shown, of[i - 1].edges.rmse_shown / std::sqrt(2.0)) << i;
    EXPECT_LT(of[i].inside.rmse_rel, 1.05 * of[0].inside.rmse_rel) << "inside nothing is lost: " << i;
  }
  EXPECT_LT(std::log2(of[3].edges.rmse_rel / of[0].edges.rmse_rel) / 3, -0.8);
  EXPECT_LT(of[0].inside.rmse_rel, 0.1 * of[3].edges.rmse_rel);
}

TEST(AreaError, IsMeasuredOnlyWhereARowHasSamples) {
  const CompareReport report = compared_samples(in_the_sun().scene, {1});
  ASSERT_TRUE(report.rows[0].error);
  EXPECT_FALSE(report.rows[0].error->area);
}

// Else what samples change at edges would be told of the rasteriser.
TEST(AreaError, OfOpenClsSurfacesIsAgainstAsManySamplesAsTheReferenceHas) {
  const Scene scene = in_the_sun().scene;
  const CompareReport one = compared_samples(scene, {1}), four = compared_samples(scene, {4});
  ASSERT_TRUE(one.own_surfaces && one.own_surfaces->error && four.own_surfaces && four.own_surfaces->error);
  EXPECT_EQ(four.own_surfaces->error->rmse, one.own_surfaces->error->rmse);
  EXPECT_EQ(four.own_surfaces->error->silhouettes->silhouettes,
            one.own_surfaces->error->silhouettes->silhouettes);
  ASSERT_TRUE(four.rows[0].same_surfaces && four.rows[0].error);
  EXPECT_TRUE(four.rows[0].same_surfaces->bit_identical) << "against every light on four samples";
  EXPECT_GT(four.rows[0].error->rmse, 10 * four.own_surfaces->error->rmse);
}

// Two pictures of the mean: by rays in double, and by the rasteriser at 16 times the size, shadows included.
TEST(AreaTruth, IsThePictureAtSixteenTimesTheSize) {
  const SmallScene s = small_scene_of_casters();
  const FineTruth fine(software_devices(), s.scene, small_view(32 * FineTruth::side, 20 * FineTruth::side));
  TechniqueRun run(software_devices(), s.scene, small_view(32, 20), {}, find_technique("visibility"));
  SceneOcclusion occlusion(s.scene);
  const AreaTruth truth = area_truth(run.view(), occlusion);
  EXPECT_GT(truth.pixels.size(), 300u);
  const AreaError apart = area_error(fine.image, truth, 1, 1);
  RecordProperty("apart",
                 fmt::format("edges {:.5f}, inside {:.6f}", apart.edges.rmse_shown, apart.inside.rmse_shown));
  EXPECT_LT(apart.edges.rmse_shown, 0.005);
  EXPECT_LT(apart.inside.rmse_shown, 0.002);
}

}  // namespace
}  // namespace lightgrid::lab
