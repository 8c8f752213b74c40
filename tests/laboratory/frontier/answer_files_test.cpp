// frontier.json, frontier.csv and samples.csv of an answer written by hand.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "frontier/answer.h"
#include "frontier/some_records.h"
#include "support/csv_rows.h"
#include "support/read_files.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

// The contract with those who read it: keys may be added, none may go without another schema_version.
TEST(FrontierJson, HasTheAgreedKeys) {
  const json frontier = to_json(some_answer());
  EXPECT_THAT(keys(frontier),
              IsSupersetOf({"schema_version", "machine", "commit", "seed", "scenes", "points", "controls",
                            "cheapest_within_flip", "flip_front_bands", "break_even", "failures"}));
  EXPECT_EQ(frontier["schema_version"], 3);
  const json& point = frontier["points"][0];
  EXPECT_THAT(keys(point),
              IsSupersetOf({"scene", "technique", "settings", "views", "frame_ms", "frame_ms_within",
                            "relative_time", "error", "pairs", "listed_per_lit", "memory_bytes", "fronts"}));
  EXPECT_THAT(keys(point["frame_ms"]), IsSupersetOf({"median", "ci95", "runs"}));
  EXPECT_THAT(keys(point["relative_time"]), IsSupersetOf({"estimate", "ci95", "runs", "processes",
                                                          "between_processes", "modes", "slow_share"}));
  for (const char* kind : {"model", "precision", "technique", "total"}) {
    EXPECT_THAT(keys(point["error"][kind]),
                IsSupersetOf({"max_rel", "rmse_rel", "p99_rel", "flip_mean", "displayed_flip", "rel_mse",
                              "rel_mse_trimmed", "smape", "smape_trimmed", "energy_rel", "rmse_of_mean",
                              "low_pass_rmse_of_mean"}));
  }
  EXPECT_THAT(keys(frontier["break_even"][0]),
              IsSupersetOf({"scene", "tighter", "looser", "ns_per_pixel_light"}));
  EXPECT_THAT(keys(frontier["failures"][0]), IsSupersetOf({"scene", "technique", "settings", "why"}));
}

TEST(FrontierJson, HoldsTheAnswer) {
  const FrontierAnswer answer = some_answer();
  const json frontier = to_json(answer);
  const std::string scene = answer.points[0].point.scene;
  EXPECT_EQ(frontier["commit"], "9d11b69");
  EXPECT_EQ(frontier["seed"], 18446744073709551615u);
  EXPECT_EQ(frontier["request"], "0123456789abcdef");
  EXPECT_EQ(frontier["baseline"], "forward_plus");
  EXPECT_EQ(frontier["scenes"], (json{scene, "hall"}));
  EXPECT_EQ(frontier["machine"]["cl_device"], "cpu-haswell");
  EXPECT_EQ(frontier["machine"]["load_at_start"], 0.25);
  EXPECT_EQ(frontier["machines"][1]["cl_device"], "another");
  EXPECT_EQ(frontier["machines"][1]["shard"], 2);
  ASSERT_EQ(frontier["points"].size(), 2u);
  const json expected = json::parse(R"({
    "technique": "forward_plus", "settings": {"tile": 8, "cull_test": "planes+aabb"}, "label": "forward_plus:tile=8",
    "frames": 4, "size": [160, 91], "views": 2, "exposure_ev": -1.5,
    "frame_ms": {"median": 2.5, "ci95": [2.25, 3.0], "runs": 8},
    "frame_ms_within": {"p95": 4.0, "p99": 5.0},
    "relative_time": {"estimate": 0.5, "ci95": [0.25, 0.75], "runs": 8, "processes": 2, "between_processes": 0.125,
                      "modes": [], "slow_share": null, "views_ci95": [null, null]},
    "pairs": {"listed": 2000, "lit": 800, "lost": 4, "wrong": 2}, "listed_per_lit": 2.5,
    "memory_bytes": 5000, "bytes_moved": 7000, "nan_pixels": 6, "fronts": {"total": {"on": true, "probability": 0.875}}})");
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(frontier["points"][0][key], value) << key;
  const json& error = frontier["points"][0]["error"];
  EXPECT_EQ(error["total"]["flip_mean"], 0.0123);
  EXPECT_EQ(error["total"]["displayed_flip"], json::parse(R"({"mean": 0.03125, "visible_share": 0.1875})"));
  EXPECT_EQ(error["total"]["energy_rel"], -3);
  EXPECT_EQ(error["model"]["displayed_flip"], nullptr);
  EXPECT_EQ(error["authored"]["total"]["displayed_flip"]["mean"], 0.015625);
  EXPECT_EQ(error["authored"]["model"]["smape"], 1);
  EXPECT_EQ(error["surfaces"]["energy_rel"], -8.25);
  EXPECT_EQ(error["surfaces"]["displayed_flip"]["mean"], 0.0625);
  EXPECT_EQ(error["seeds"]["pictures"], 32);
  EXPECT_EQ(error["seeds"]["deviation"]["rel_mse"], 5);
  // 4e-10 and 2.1448 errors (14 degrees of freedom, of published tables) to either side.
  EXPECT_NEAR(error["seeds"]["bias_rmse_rel_ci95"][0].get<double>(), std::sqrt(1.8552e-10), 1e-9);
  EXPECT_NEAR(error["seeds"]["bias_rmse_rel_ci95"][1].get<double>(), std::sqrt(6.1448e-10), 1e-9);
  EXPECT_EQ(error["sequences"]["frames"], 64);
  EXPECT_EQ(error["sequences"]["still"]["plain"], json::parse(R"({"largest_flicker": 0.015625,
    "flicker": {"mean": 0.0078125, "visible_share": 0.01171875},
    "displayed_flip": {"mean": 0.01953125, "visible_share": 0.0234375}})"));
  EXPECT_EQ(error["sequences"]["moving_lights"]["filtered"]["displayed_flip"]["visible_share"], 31.0 / 256);
  EXPECT_EQ(frontier["pixels_per_degree"], 67);
  EXPECT_EQ(error["total"]["rmse_rel"], 4.0 / 3);
  EXPECT_EQ(error["precision"]["p99_rel"], 0.022);
  EXPECT_EQ(error["technique"]["max_rel"], answer.points[0].errors.technique.max_rel);
  EXPECT_EQ(error["model"]["relative_rmse"], 0.07);
  EXPECT_EQ(error["model"]["flip_mean"], nullptr);
  json sampled = json::parse(R"({"pixels": 9000, "max_rel": 0.5, "rmse_rel": 1.6666666666666667,
    "relative_rmse": 0.35000000000000003, "rel_mse": 2.5, "rel_mse_trimmed": 1.25, "smape": 0.625,
    "smape_trimmed": 0.3125, "energy_rel": -3.75, "rmse_of_mean": 7.5})");
  sampled["p99_rel"] = 0.011 * 5;
  sampled["float_total_max_rel"] = 0.1 * 7;
  sampled["float_total_rmse_rel"] = 7.0 / 3;
  sampled["float_truth_max_rel"] = 0.1 * 6;
  sampled["float_truth_rmse_rel"] = 2.0;
  EXPECT_EQ(error["in_double"], sampled);
  EXPECT_EQ(error["flip_views"], 2);
  EXPECT_EQ(error["temporal_views"], 1);
  EXPECT_EQ(error["bias_rmse_rel"], 1e-5);
  EXPECT_EQ(error["deviation_rmse_rel"], 2e-5);
  EXPECT_EQ(frontier["cheapest_within_flip"], (json{{{"scene", scene},
                                                     {"of", "total"},
                                                     {"flip", 1e-3},
                                                     {"point", 0},
                                                     {"probability", 0.5},
                                                     {"p_cheapest_views", 0.0},
                                                     {"relative_time", expected["relative_time"]}}}));
  EXPECT_EQ(
      frontier["flip_front_bands"],
      (json{{{"scene", scene}, {"of", "total"}, {"steps", {{{"flip", 1e-3}, {"ci95", {0.25, 0.75}}}}}}}));
  const json& control = frontier["controls"][0];
  EXPECT_EQ(control["passed"], false) << "6 % off, although its interval holds 1";
  EXPECT_EQ(control["places"], (json{1.0, 1.125}));
  EXPECT_NEAR(control["widened_by"].get<double>(), 1.0625, 1e-12);
  EXPECT_EQ(frontier["break_even"], json::parse(R"([{"scene": "hall", "tighter": "exact", "looser": "sphere",
    "ns_per_pixel_light": 0.25, "ci95": [0.125, 0.5], "rounds": 12, "extra_ms": 1.5, "pairs_saved": 1000.0}])"));
  EXPECT_EQ(frontier["shading_costs"],
            json::parse(R"([{"scene": "hall", "technique": "forward_plus", "brdf": "ggx",
    "ns_per_pixel_light": 0.75, "ci95": [0.5, 1.0]}])"));
  EXPECT_EQ(frontier["growth"],
            json::parse(R"([{"scene": "hall", "technique": "forward_plus", "of": "lights", "kept": null,
    "exponent": 0.5, "ci95": [0.25, 0.75], "samples": [[100.0, 1.0], [400.0, 2.0], [1600.0, 4.0]]}])"));
  EXPECT_EQ(frontier["failures"][0]["label"], "forward_plus:tile=32");
  EXPECT_EQ(frontier["failures"][0]["cause"], "refused");
  EXPECT_EQ(frontier["sentences"], (json{"One.", "Two."}));
}

TEST(FrontierJson, HasTheWarningsOfTheRun) {
  FrontierAnswer answer = some_answer();
  EXPECT_EQ(to_json(answer)["warnings"], json::array());
  answer.part.warnings = {{"no range", {"range=cutoff"}, "lightgrid frontier --set range=cutoff"}};
  const json expected = {{{"text", "no range"},
                          {"settings", {"range=cutoff"}},
                          {"command", "lightgrid frontier --set range=cutoff"}}};
  EXPECT_EQ(to_json(answer)["warnings"], expected);
}

TEST(FrontierJson, HasNullForWhatIsNotFinite) {
  FrontierAnswer answer = some_answer();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  answer.points[0].errors.total.max_rel = std::nan("");
  answer.points[0].frame_ms = {};
  answer.points[0].pairs.lit = 0;
  answer.break_even[0].ns_per_pixel_light = infinity;
  answer.growth[0].low = -infinity;
  answer.break_even[0].rounds = 0;
  const json frontier = json::parse(to_json(answer).dump());
  EXPECT_EQ(frontier["points"][0]["error"]["total"]["max_rel"], nullptr);
  EXPECT_EQ(frontier["points"][0]["frame_ms"],
            json::parse(R"({"median": null, "ci95": [null, null], "runs": 0})"));
  EXPECT_EQ(frontier["points"][0]["listed_per_lit"], nullptr);
  EXPECT_EQ(frontier["break_even"][0]["ns_per_pixel_light"], nullptr);
  EXPECT_EQ(frontier["break_even"][0]["ci95"], json::parse("[null, null]"));
  EXPECT_EQ(frontier["growth"][0]["ci95"], json::parse("[null, 0.75]"));
}

TEST(FrontierJson, OfNothingHasEmptyLists) {
  const json frontier = to_json(FrontierAnswer{});
  for (const char* list : {"scenes", "points", "controls", "cheapest_within_flip", "flip_front_bands",
                           "break_even", "shading_costs", "growth", "failures", "sentences", "machines"}) {
    EXPECT_EQ(frontier[list], json::array()) << list;
  }
}

TEST(FrontierCsv, HasALineAPointAndView) {
  const FrontierAnswer answer = some_answer();
  const auto table = csv_rows(csv_text(answer));
  ASSERT_EQ(table.size(), 5u);
  const std::map<std::string, std::string> expected = {{"row", "1"},
                                                       {"commit", "9d11b69"},
                                                       {"seed", "18446744073709551615"},
                                                       {"shard", "1"},
                                                       {"cl", "cpu-haswell"},
                                                       {"gl", "llvmpipe"},
                                                       {"scene", answer.points[0].point.scene},
                                                       {"label", "forward_plus:tile=8"},
                                                       {"technique", "forward_plus"},
                                                       {"settings", "cull_test=planes+aabb tile=8"},
                                                       {"frames", "4"},
                                                       {"series", ""},
                                                       {"view", "1"},
                                                       {"width", "160"},
                                                       {"height", "91"},
                                                       {"lights", "1024"},
                                                       {"radius_scale", "1.5"},
                                                       {"refused", ""},
                                                       {"runs", "3"},
                                                       {"frame_ms", "2.25"},
                                                       {"frame_ms_low", "0.3333333333333333"},
                                                       {"frame_ms_high", "2.5"},
                                                       {"baseline_ms", "2.5"},
                                                       {"ratio", "0.5"},
                                                       {"ratio_high", "0.9"},
                                                       {"bytes_moved", "18446744073709551615"},
                                                       {"memory_bytes", "9007199254740993"},
                                                       {"covered_pixels", "14000"},
                                                       {"listed", "1000"},
                                                       {"lit", "400"},
                                                       {"lost", "2"},
                                                       {"wrong", "1"},
                                                       {"nan_pixels", "3"},
                                                       {"overflow", "5"},
                                                       {"model_max_rel", "0.1"},
                                                       {"precision_rmse_rel", "0.6666666666666666"},
                                                       {"technique_relative_rmse", "0.21000000000000002"},
                                                       {"total_p99_rel", "0.044"},
                                                       {"total_flip_mean", "0.0123"},
                                                       {"total_displayed_flip_mean", "0.03125"},
                                                       {"total_displayed_flip_visible_share", "0.1875"},
                                                       {"model_displayed_flip_mean", ""},
                                                       {"model_low_pass_rmse_of_mean", "0.375"},
                                                       {"exposure_ev", "-1.5"},
                                                       {"seeds_pictures", "32"},
                                                       {"seeds_deviation_rel_mse", "5"},
                                                       {"seeds_deviation_displayed_flip_mean", "0.5"},
                                                       {"authored_total_rmse_rel", "3"},
                                                       {"authored_total_displayed_flip_mean", "0.015625"},
                                                       {"authored_model_smape", "1"},
                                                       {"model_flip_mean", ""},
                                                       {"bias_rmse_rel", "1e-05"},
                                                       {"deviation_rmse_rel", "2e-05"},
                                                       {"image", "sponza_17"},
                                                       {"in_double_pixels", "9000"},
                                                       {"in_double_relative_rmse", "0.35000000000000003"},
                                                       {"in_double_float_truth_rmse_rel", "2"}};
  for (const auto& [name, value] : expected) EXPECT_EQ(table[1].at(name), value) << name;
  EXPECT_EQ(table[1].at("still_plain_flicker_mean"), "0.0078125");
  EXPECT_EQ(table[1].at("dolly_filtered_largest_flicker"), "0.07421875");
  EXPECT_EQ(table[1].at("moving_lights_plain_displayed_flip_visible_share"), "0.1015625");
  EXPECT_EQ(std::stod(table[1].at("ratio_low")), (1.0 / 3) / (2.0 / 3 + 1));
  EXPECT_EQ(table[4].at("refused"), "needs \"OpenGL\", which is not here");
  for (const char* name : {"frame_ms", "ratio", "listed", "nan_pixels", "total_rmse_rel"})
    EXPECT_EQ(table[4].at(name), "");
  EXPECT_EQ(table[4].at("cl"), "") << "nobody has said which machine shard 0 ran on";
}

TEST(FrontierCsv, HasEachRunBeside) {
  const FrontierAnswer answer = some_answer();
  const auto table = csv_rows(samples_csv_text(answer));
  ASSERT_EQ(table.size(), 12u);
  for (size_t i = 0; i < table.size(); ++i) {
    const FrontierRecord& record = answer.part.records[i / 3];
    EXPECT_EQ(table[i].at("row"), std::to_string(i / 3));
    EXPECT_EQ(table[i].at("run"), std::to_string(i % 3));
    EXPECT_EQ(table[i].at("process"), i / 3 == 4 || i % 3 < 2 ? "0" : "1");
    EXPECT_EQ(std::stod(table[i].at("frame_ms")), record.frame_ms[i % 3]);
    EXPECT_EQ(std::stod(table[i].at("baseline_ms")), record.baseline_ms[i % 3]);
  }
}

TEST(FrontierCsv, HasEachRoundOfCulling) {
  const auto table = csv_rows(cull_csv_text(some_answer()));
  ASSERT_EQ(table.size(), 15u);
  EXPECT_EQ(table[4].at("row"), "1");
  EXPECT_EQ(table[4].at("round"), "1");
  EXPECT_EQ(table[4].at("cull_ms"), "0.125");
}

}  // namespace
}  // namespace lightgrid::lab
