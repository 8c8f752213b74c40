// By how much the truths on the surfaces of the two rasterizers differ: which points have it, and what it is.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "frontier/answer.h"
#include "frontier/synthetic_records.h"
#include "frontier/view_figures.h"
#include "measures/metrics.h"
#include "scenes/builtin.h"
#include "support/csv_rows.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

// A scene on one view, as a sweep measures it.
struct MeasuredView {
  MeasuredView(Renderer& devices, const Scene& of, const View& from)
      : renderer(devices), scene(of), view(from), gpu(devices, of) {}
  Renderer& renderer;
  const Scene& scene;
  const View view;
  FrontierJob job;
  GpuScene gpu;

  std::vector<FrontierRecord> records(const std::vector<std::string>& points) {
    job.points = chosen_points(points, {}, job.common, renderer.gl != nullptr);
    SceneChoice choice;
    choice.exposure = "0";
    ViewFigures figures(renderer, gpu, scene, view, job, choice);
    figures.look(view, 1, true, false);
    std::vector<FrontierRecord> all;
    for (const ChosenPoint& point : job.points) {
      PointRun run(renderer, gpu, view, point, std::make_shared<TargetPool>());
      FrontierRecord& record = all.emplace_back();
      record.point = described("scene", point);
      record.view = 1;
      figures.measure(run, record);
      EXPECT_EQ(record.refused, "") << record.point.label;
    }
    return all;
  }
  Image picture(const std::string& point) {
    const Contestant of = chosen_points({point}, {}, {}, true).at(0).contestant;
    TechniqueRun run(renderer, gpu, view, of.settings, *of.technique);
    run.run_frame(true);
    return run.take_image();
  }
};

struct TruthDifference {
  double rmse = 0, rel_mse = 0, energy = 0, brightest = 0;
};

// By the formulas of docs/details/frontier.md#measures.
TruthDifference difference_of(const Image& image, const Image& truth) {
  TruthDifference found;
  double luminance = 0, sum = 0, sum_of_truth = 0;
  for (const glm::vec4& t : truth.pixels) {
    luminance += 0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b;
    found.brightest = std::max({found.brightest, double(t.r), double(t.g), double(t.b)});
  }
  const double pixels = double(truth.pixels.size()), dark = luminance / pixels / 100;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double t = truth.pixels[i][c], x = image.pixels[i][c];
      found.rmse += (x - t) * (x - t) / (3 * pixels);
      found.rel_mse += (x - t) * (x - t) / (t * t + dark * dark) / (3 * pixels);
      sum += x;
      sum_of_truth += t;
    }
  }
  found.rmse = std::sqrt(found.rmse);
  found.energy = sum / sum_of_truth - 1;
  return found;
}

TEST(SurfacesFloor, IsTheOneTruthAgainstTheOther) {
  const Scene scene = find_builtin_scene("street")->make();
  MeasuredView measured(software_devices(), scene, make_view(scene.cameras.at(0), 96, 54));
  const Image opengl = measured.picture("forward:range=infinite"),
              opencl = measured.picture("visibility:range=infinite");
  const TruthDifference expected = difference_of(opencl, opengl), swapped = difference_of(opengl, opencl);
  ASSERT_GT(expected.rmse, 1e-5 * expected.brightest);
  ASSERT_GT(std::abs(expected.rel_mse - swapped.rel_mse), 0.01 * expected.rel_mse) << "has a direction";

  const auto records = measured.records({"visibility", "visibility:range=infinite", "forward_plus"});
  for (const FrontierRecord& record : records) {
    if (record.point.technique == "forward_plus") {
      EXPECT_FALSE(record.errors.surfaces) << "it is compared with the truth on OpenGL's surfaces";
      continue;
    }
    ASSERT_TRUE(record.errors.surfaces) << record.point.label;
    const ImageError& surfaces = *record.errors.surfaces;
    EXPECT_NEAR(surfaces.rmse_rel, expected.rmse / expected.brightest, 1e-3 * surfaces.rmse_rel);
    EXPECT_NEAR(surfaces.rel_mse, expected.rel_mse, 1e-3 * expected.rel_mse);
    EXPECT_NEAR(surfaces.energy_rel, expected.energy, 1e-3 * std::abs(expected.energy) + 1e-7);
    ASSERT_TRUE(surfaces.displayed);
    EXPECT_GT(surfaces.displayed->mean, 0);
    EXPECT_FALSE(surfaces.flip_mean);
  }
  // Its own truth it hits far more closely than that truth hits OpenGL's.
  EXPECT_LT(100 * records[1].errors.total.rmse_rel, records[1].errors.surfaces->rmse_rel);
}

TEST(SurfacesFloor, IsNoneWhereThereIsOneTruthOrOneRasterizer) {
  const SmallScene s = small_scene();
  MeasuredView of_areas(software_devices(), s.scene, small_view(17, 9));
  of_areas.job.truth = chosen_truth({}, false, {}, true);
  ASSERT_TRUE(of_areas.job.truth.places);
  EXPECT_FALSE(of_areas.records({"visibility"}).at(0).errors.surfaces);
  MeasuredView without_opengl(opencl_devices(), s.scene, small_view(17, 9));
  EXPECT_FALSE(without_opengl.records({"visibility"}).at(0).errors.surfaces);
  MeasuredView with_both(software_devices(), s.scene, small_view(17, 9));
  EXPECT_TRUE(with_both.records({"visibility"}).at(0).errors.surfaces);
}

// Two views of two points: of `error`, and of surfaces of their own that differ by 0.03 and 0.04.
std::vector<FrontierRecord> views_of(double error) {
  std::vector<FrontierRecord> records;
  for (const int view : {0, 1}) {
    const double differ = view == 0 ? 0.03 : 0.04;
    records.push_back(synthetic_record(synthetic_point("hall", "visibility"), 0.5, error, view));
    ImageError& surfaces = records.back().errors.surfaces.emplace(synthetic_error(2 * differ, differ, 0, 0));
    surfaces.displayed = DisplayedFlip{differ, 0.5};
    records.push_back(synthetic_record(synthetic_point("hall", "forward_plus"), 1, error, view));
  }
  return records;
}

TEST(SurfacesFloor, IsJoinedOverViewsAndAKeyOfItsOwn) {
  FrontierPart part = synthetic_part(views_of(0.1));
  const json both = to_json(answer_of({part}));
  ASSERT_THAT(both["points"], SizeIs(2));
  const json& surfaces = both["points"][0]["error"]["surfaces"];
  EXPECT_EQ(surfaces["max_rel"], 0.08) << "the largest";
  EXPECT_NEAR(surfaces["rmse_rel"].get<double>(), std::sqrt((0.03 * 0.03 + 0.04 * 0.04) / 2), 1e-12);
  EXPECT_NEAR(surfaces["displayed_flip"]["mean"].get<double>(), 0.035, 1e-12);
  EXPECT_FALSE(both["points"][1]["error"].contains("surfaces"));
  const auto rows = csv_rows(csv_text(answer_of({part})));
  EXPECT_EQ(rows.at(0).at("surfaces_rmse_rel"), "0.03");
  EXPECT_EQ(rows.at(0).at("surfaces_displayed_flip_mean"), "0.03");
  EXPECT_EQ(rows.at(1).at("surfaces_rmse_rel"), "");

  // A view without it, as of an earlier version: then the point has none.
  part.records[2].errors.surfaces.reset();
  const json one = to_json(answer_of({part}));
  EXPECT_FALSE(one["points"][0]["error"].contains("surfaces"));
  EXPECT_EQ(one["points"][0]["error"]["total"], both["points"][0]["error"]["total"]);
  part.records[0].errors.surfaces.reset();
  EXPECT_EQ(csv_rows(csv_text(answer_of({part}))).at(0).count("surfaces_rmse_rel"), 0u);
}

TEST(SurfacesFloor, IsToldWhereAPointOfTheFrontLiesBelow) {
  const auto told = HasSubstr(
      "In hall the surfaces of OpenGL and of the rasterizer in OpenCL differ by a FLIP of 0.0350: smaller "
      "errors "
      "do not compare points of one kind with points of the other.");
  EXPECT_THAT(answer_from(views_of(0.034)).sentences, Contains(told));
  EXPECT_THAT(answer_from(views_of(0.036)).sentences, Not(Contains(told)));
}

}  // namespace
}  // namespace lightgrid::lab
