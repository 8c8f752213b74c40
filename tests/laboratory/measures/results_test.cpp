#include "measures/results.h"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "measures/results.h"
#include "report/synthetic_report.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

RunResult small_result() {
  RunResult result;
  result.technique = "forward_plus";
  result.settings = {{"tile", "16"},
                     {"cull-test", "planes+aabb"},
                     {"radius-cutoff", "0.01"},
                     {"mask", "true"},
                     {"odd", "nan"}};
  result.lights_total = 1024;
  result.lights_in_view = 871;
  result.frame_ms = {1, 2, 3, 4, 5};
  result.passes = {{"depth_prepass", "gl", 0.5, 10, 20},
                   {"resolve", "cl", 0.75, 30, 40, {{"resolve", 0.25}}}};
  result.memory_total = 3;
  result.memory_light_grid = 2;
  result.memory_gbuffer = 1;
  result.pairs = PairCounts{9, 8, 7, 6};
  result.error = ImageError{
      0.5,
      0.25,
      0.125,
      0.0625,
      {},
      false,
      OracleError{0.75, 0.375, 0.875},
      SilhouetteError{
          .silhouettes = 1, .blended = 2, .inside = 5, .max_rel = 0.25, .rmse_rel = 0.125, .p99_rel = 0.0625},
      SurfacesError{.pixels = 4, .sum_rel = -0.5, .max_rel = 0.75, .rmse_rel = 0.25, .p99_rel = 0.375},
      0.1875,
      0.03125,
      0,
      DisplayedFlip{0.25, 0.5}};
  result.nan_pixels = 11;
  result.inf_pixels = 13;
  result.overflow = 12;
  result.unshaded = 0.25;
  result.cpu_ms = {3, 5, 2};
  result.skipped = {{"shadows", "no light casts one"}};
  return result;
}

TEST(Results, HoldTheDocumentedKeysAndNoOthers) {
  const json expected = json::parse(R"({
    "technique": "forward_plus",
    "settings": {"tile": 16, "cull_test": "planes+aabb", "radius_cutoff": 0.01, "mask": true, "odd": "nan"},
    "lights": {"total": 1024, "in_view": 871},
    "frame_ms": {"min": 1.0, "median": 2.0, "max": 4.0, "runs": 5},
    "frame_cpu_ms": {"min": 2.0, "median": 3.0, "max": 5.0, "runs": 3},
    "passes": [{"name": "depth_prepass", "on": "gl", "median_ms": 0.5, "bytes_read": 10, "bytes_written": 20, "kernels": []},
               {"name": "resolve", "on": "cl", "median_ms": 0.75, "bytes_read": 30, "bytes_written": 40,
                "kernels": [{"name": "resolve", "median_ms": 0.25}]}],
    "memory_bytes": {"total": 3, "light_grid": 2, "gbuffer": 1},
    "pairs": {"listed": 9, "lit": 8, "lost": 7, "wrong": 6},
    "same_surfaces": {"reference": "forward", "max_abs": 0.5, "max_rel": 0.25, "rmse": 0.125, "p99": 0.0625,
              "rmse_rel": 0.1875, "p99_rel": 0.03125, "bit_identical": false,
              "displayed_flip": {"mean": 0.25, "visible_share": 0.5, "visible_from": 0.05}},
    "error": {"max_abs": 0.5, "max_rel": 0.25, "rmse": 0.125, "p99": 0.0625, "flip_mean": null, "bit_identical": false,
              "rmse_rel": 0.1875, "p99_rel": 0.03125,
              "displayed_flip": {"mean": 0.25, "visible_share": 0.5, "visible_from": 0.05},
              "oracle": {"max_rel": 0.75, "rmse_rel": 0.375, "of_reference_max_rel": 0.875},
              "silhouettes": {"pixels": 1, "share": 0.125},
              "inside": {"pixels": 5, "max_rel": 0.25, "rmse_rel": 0.125, "p99_rel": 0.0625},
              "surfaces": {"pixels": 4, "sum_rel": -0.5, "max_rel": 0.75, "rmse_rel": 0.25, "p99_rel": 0.375}},
    "unshaded": 0.25, "nan_pixels": 11, "inf_pixels": 13, "overflow": 12, "skipped": [{"effect": "shadows", "why": "no light casts one"}]})");
  EXPECT_EQ(to_json(small_result()), expected);
}

TEST(Results, HoldTheErrorAgainstAreasOnlyWhereItWasMeasured) {
  RunResult result = small_result();
  EXPECT_FALSE(to_json(result)["error"].contains("area"));
  result.error->area = AreaError{{1, 0.5, 0.25, 0.125}, {2, 0.75, 0.375, 0.0625}};
  EXPECT_EQ(to_json(result)["error"]["area"], json::parse(R"({
    "edges": {"pixels": 1, "max_rel": 0.5, "rmse_rel": 0.25, "rmse_shown": 0.125},
    "inside": {"pixels": 2, "max_rel": 0.75, "rmse_rel": 0.375, "rmse_shown": 0.0625}})"));
}

TEST(Results, HoldWhatLimitedListsLeaveOut) {
  RunResult result = small_result();
  result.limited = LimitedLists{-0.25, {0.5, 0.125}};
  EXPECT_EQ(to_json(result)["limited"],
            json::parse(R"({"lost_light": -0.25, "step_at_borders": 0.5, "step_inside": 0.125})"));
}

// A scene without casters has the keys above alone.
TEST(Results, HoldShadowsOnlyWhereLightsCast) {
  RunResult result = small_result();
  result.pairs->shadows = ShadowPairs{.leaked = 1, .acned = 2, .either = 3, .pixels = 4, .pairs = 5};
  EXPECT_EQ(to_json(result)["pairs"], json::parse(R"({"listed": 9, "lit": 8, "lost": 7, "wrong": 6,
    "leaked": 1, "acned": 2, "either": 3, "shadow_pixels": 4, "shadow_pairs": 5})"));
}

TEST(Results, ShadowsAreThereIfALightCastsOne) {
  RunResult result = small_result();
  EXPECT_FALSE(to_json(result).contains("shadows"));
  result.shadows = ShadowResult{1, 2, 3, 4, 5, 6, 7, {{8, "no caster in its range"}}};
  result.shadows->halvings = 9;
  EXPECT_EQ(to_json(result)["shadows"], json::parse(R"({
    "lights": 1, "maps": 2, "drawn": 3, "kept": 4, "bytes": 5, "rays": 6, "undecided": 7,
    "halvings": 9, "skipped": [{"light": 8, "why": "no caster in its range"}]})"));
  result.shadows->bands = 11;
  result.shadows->tiles_kept = 12;
  result.shadows->dim_steps = 0.5;
  const json all = to_json(result)["shadows"];
  EXPECT_EQ(all["kept"], 4) << "maps, as ever";
  EXPECT_EQ(all["bands"], 11);
  EXPECT_EQ(all["tiles_kept"], 12);
  EXPECT_EQ(all["dim_steps"], 0.5);
}

// The error on the surfaces drawn in OpenCL, not `error`, which includes these surfaces.
TEST(Results, JudgeLightOnTheSameSurfaces) {
  RunResult result = small_result();
  result.own_surfaces = true;
  EXPECT_EQ(light_error(result), nullptr);
  EXPECT_TRUE(to_json(result)["same_surfaces"].is_null());
  result.same_surfaces = ImageError{};
  const json same = to_json(result)["same_surfaces"];
  EXPECT_EQ(same["reference"], "visibility:lights=all");
  EXPECT_EQ(same["bit_identical"], true);
  EXPECT_EQ(same["max_rel"], 0);
}

TEST(Results, OfOwnSurfacesSayHowFarTheyAreOrWhyThatIsUnknown) {
  CompareReport report = synthetic_report(17, 9);
  EXPECT_TRUE(to_json(report)["own_surfaces"].is_null());
  report.own_surfaces = OwnSurfaces{"", ImageError{.max_rel = 0.5}};
  const json drawn = to_json(report)["own_surfaces"];
  EXPECT_EQ(drawn["technique"], "visibility:lights=all");
  EXPECT_EQ(drawn["error"]["max_rel"], 0.5);
  EXPECT_TRUE(drawn["why_not"].is_null());
  report.own_surfaces = OwnSurfaces{"the reference is a sample", {}};
  const json not_drawn = to_json(report)["own_surfaces"];
  EXPECT_TRUE(not_drawn["error"].is_null());
  EXPECT_EQ(not_drawn["why_not"], "the reference is a sample");
}

TEST(Results, OfAnEmptyRunKeepEveryKey) {
  const auto empty = to_json(RunResult{});
  EXPECT_EQ(keys_of(empty), keys_of(to_json(small_result())));
  EXPECT_TRUE(empty["pairs"].is_null());
  EXPECT_TRUE(empty["error"].is_null());
  EXPECT_EQ(empty["settings"], json::object());
  EXPECT_EQ(empty["passes"], json::array());
  EXPECT_EQ(empty["skipped"], json::array());
}

TEST(Results, WriteWhatIsNotFiniteAsNull) {
  auto result = small_result();
  result.error->max_abs = std::numeric_limits<double>::infinity();
  result.frame_ms.median = std::numeric_limits<double>::quiet_NaN();
  const auto value = to_json(result);
  EXPECT_TRUE(value["error"]["max_abs"].is_null());
  EXPECT_TRUE(value["frame_ms"]["median"].is_null());
  EXPECT_EQ(json::parse(json_text(value)), value);
}

TEST(Results, OfAReportHoldTheDocumentedKeys) {
  const auto value = to_json(synthetic_report(17, 9));
  EXPECT_EQ(keys_of(value), (std::set<std::string>{"ambient", "exposure", "scene", "size", "devices",
                                                   "commit", "reference", "reference_errors", "own_surfaces",
                                                   "covered_pixels", "rows", "warnings"}));
  EXPECT_EQ(value["size"], json::parse("[17, 9]"));
  EXPECT_EQ(keys_of(value["reference"]),
            (std::set<std::string>{"technique", "pixels", "brightest", "surfaces"}));
  EXPECT_EQ(value["reference"]["technique"], "forward");
  EXPECT_EQ(value["reference"]["pixels"], 153);
  EXPECT_EQ(value["reference"]["surfaces"], value["rows"][0]["error"]["surfaces"]);
  EXPECT_EQ(keys_of(value["devices"]), (std::set<std::string>{"cl", "gl"}));
  EXPECT_EQ(keys_of(value["reference_errors"]),
            (std::set<std::string>{"model", "precision", "pixels_left_out"}));
  EXPECT_EQ(value["rows"].size(), 7u);
}

TEST(Results, WithoutAnOracleHaveNoReferenceErrors) {
  auto report = synthetic_report(17, 9);
  report.reference_errors.reset();
  EXPECT_TRUE(to_json(report)["reference_errors"].is_null());
  auto result = small_result();
  result.error->oracle.reset();
  EXPECT_TRUE(to_json(result)["error"]["oracle"].is_null());
  result.error->silhouettes.reset();
  EXPECT_TRUE(to_json(result)["error"]["silhouettes"].is_null());
  EXPECT_TRUE(to_json(result)["error"]["inside"].is_null());
  result.error->surfaces.reset();
  EXPECT_TRUE(to_json(result)["error"]["surfaces"].is_null());
  report.reference_surfaces.reset();
  EXPECT_TRUE(to_json(report)["reference"]["surfaces"].is_null());
}

TEST(Results, AreTextEvenWhereANameIsNotUtf8) {
  EXPECT_THAT(json_text(json("caf\xe9")), testing::HasSubstr("caf\xef\xbf\xbd"));
}

}  // namespace
}  // namespace lightgrid::lab
