// Records as JSON, and the keys by which they are found again.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "frontier/faults.h"
#include "frontier/fields.h"
#include "frontier/record_file.h"
#include "frontier/some_records.h"

namespace lightgrid::lab {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using testing::AllOf;
using testing::HasSubstr;

TEST(FrontierRecords, KeepEveryFieldAsJson) {
  const FrontierRecord r = some_record(8, 2);
  const nlohmann::json written = to_json(r);
  const FrontierRecord read = record_of(nlohmann::json::parse(written.dump()));
  EXPECT_EQ(read.point.scene, r.point.scene);
  EXPECT_EQ(read.point.technique, r.point.technique);
  EXPECT_EQ(read.point.settings, r.point.settings);
  EXPECT_EQ(read.point.label, r.point.label);
  EXPECT_EQ(read.point.frames, r.point.frames);
  EXPECT_EQ(read.view, r.view);
  EXPECT_EQ(read.width, r.width);
  EXPECT_EQ(read.height, r.height);
  EXPECT_EQ(read.lights, r.lights);
  EXPECT_EQ(read.radius_scale, r.radius_scale);
  EXPECT_EQ(read.series, r.series);
  EXPECT_EQ(read.refused, r.refused);
  EXPECT_EQ(read.frame_ms, r.frame_ms);
  EXPECT_EQ(read.baseline_ms, r.baseline_ms);
  EXPECT_EQ(read.processes, r.processes);
  for (const auto& [key, times] : times_by_device) {
    EXPECT_FALSE((r.*times).empty()) << key;
    EXPECT_EQ(read.*times, r.*times) << key;
  }
  EXPECT_EQ(read.pass_ms, r.pass_ms);
  EXPECT_EQ(read.cull_ms, r.cull_ms);
  EXPECT_EQ(read.bytes_moved, r.bytes_moved);
  EXPECT_EQ(read.memory_bytes, r.memory_bytes);
  EXPECT_EQ(read.covered_pixels, r.covered_pixels);
  EXPECT_EQ(read.pairs.listed, r.pairs.listed);
  EXPECT_EQ(read.pairs.lit, r.pairs.lit);
  EXPECT_EQ(read.pairs.lost, r.pairs.lost);
  EXPECT_EQ(read.pairs.wrong, r.pairs.wrong);
  EXPECT_EQ(read.nan_pixels, r.nan_pixels);
  EXPECT_EQ(read.overflow, r.overflow);
  EXPECT_EQ(read.errors.model.max_rel, r.errors.model.max_rel);
  EXPECT_EQ(read.errors.precision.rmse_rel, r.errors.precision.rmse_rel);
  EXPECT_EQ(read.errors.technique.relative_rmse, r.errors.technique.relative_rmse);
  EXPECT_EQ(read.errors.total.p99_rel, r.errors.total.p99_rel);
  EXPECT_EQ(read.errors.total.flip_mean, r.errors.total.flip_mean);
  EXPECT_EQ(read.errors.model.flip_mean, std::nullopt);
  ASSERT_TRUE(read.errors.total.displayed);
  EXPECT_EQ(read.errors.total.displayed->mean, r.errors.total.displayed->mean);
  EXPECT_EQ(read.errors.total.displayed->visible, r.errors.total.displayed->visible);
  EXPECT_EQ(read.errors.model.displayed.has_value(), false);
  EXPECT_EQ(read.errors.precision.rel_mse_trimmed, r.errors.precision.rel_mse_trimmed);
  EXPECT_EQ(read.errors.technique.energy_rel, r.errors.technique.energy_rel);
  EXPECT_EQ(read.exposure_ev, r.exposure_ev);
  ASSERT_TRUE(read.errors.seeds);
  EXPECT_EQ(read.errors.seeds->pictures, 32);
  EXPECT_EQ(read.errors.seeds->flip_pictures, 8);
  EXPECT_EQ(read.errors.seeds->deviation.rel_mse, r.errors.seeds->deviation.rel_mse);
  EXPECT_EQ(read.errors.seeds->bias_mse_rel, r.errors.seeds->bias_mse_rel);
  EXPECT_EQ(read.errors.seeds->bias_mse_rel_error, r.errors.seeds->bias_mse_rel_error);
  ASSERT_TRUE(read.errors.authored);
  EXPECT_EQ(read.errors.authored->model.smape, r.errors.authored->model.smape);
  EXPECT_EQ(read.errors.authored->total.displayed->mean, r.errors.authored->total.displayed->mean);
  ASSERT_TRUE(read.errors.in_double);
  EXPECT_EQ(read.errors.in_double->pixels, r.errors.in_double->pixels);
  EXPECT_EQ(read.errors.in_double->picture.max_rel, r.errors.in_double->picture.max_rel);
  EXPECT_EQ(read.errors.in_double->picture_in_float.rmse_rel, r.errors.in_double->picture_in_float.rmse_rel);
  EXPECT_EQ(read.errors.in_double->truth.rmse_rel, r.errors.in_double->truth.rmse_rel);
  EXPECT_EQ(read.errors.bias_rmse_rel, r.errors.bias_rmse_rel);
  EXPECT_EQ(read.errors.deviation_rmse_rel, r.errors.deviation_rmse_rel);
  EXPECT_EQ(read.errors.temporal_rmse_rel, r.errors.temporal_rmse_rel);
  ASSERT_TRUE(read.errors.sequences);
  EXPECT_EQ(read.errors.sequences->frames, 64);
  EXPECT_EQ(read.errors.sequences->still.plain.flicker.mean, 2.0 / 256);
  EXPECT_EQ(read.errors.sequences->still.filtered.largest_flicker, 9.0 / 256);
  EXPECT_EQ(read.errors.sequences->dolly.plain.displayed.mean, 15.0 / 256);
  EXPECT_EQ(read.errors.sequences->moving_lights.filtered.displayed.visible, 31.0 / 256);
  ASSERT_TRUE(read.errors.surfaces);
  EXPECT_EQ(read.errors.surfaces->energy_rel, r.errors.surfaces->energy_rel);
  EXPECT_EQ(read.errors.surfaces->displayed->visible, 0.375);
  ASSERT_TRUE(read.flip);
  EXPECT_EQ(read.flip->start, r.flip->start);
  EXPECT_EQ(read.flip->stop, r.flip->stop);
  EXPECT_EQ(read.flip->count, r.flip->count);
  EXPECT_EQ(read.image, r.image);
}

TEST(FrontierRecords, KeepNanAndInfinity) {
  FrontierRecord r = some_record(8, 0);
  r.errors.total = {.max_rel = infinite, .rmse_rel = std::nan(""), .p99_rel = -infinite};
  r.errors.bias_rmse_rel = std::nan("");
  r.errors.deviation_rmse_rel.reset();
  r.frame_ms[1] = infinite;
  const FrontierRecord read = record_of(nlohmann::json::parse(to_json(r).dump()));
  EXPECT_EQ(read.errors.total.max_rel, infinite);
  EXPECT_TRUE(std::isnan(read.errors.total.rmse_rel));
  EXPECT_EQ(read.errors.total.p99_rel, -infinite);
  EXPECT_TRUE(std::isnan(read.errors.bias_rmse_rel.value()));
  EXPECT_EQ(read.errors.deviation_rmse_rel, std::nullopt);
  EXPECT_EQ(read.frame_ms[1], infinite);
}

// Without a field, and with one of another type.
TEST(FrontierRecords, NameAWrongField) {
  const nlohmann::json good = to_json(some_record(8, 0));
  for (const auto& [name, value] : good.items()) {
    nlohmann::json line = good;
    line.erase(name);
    if (name == "processes") {  // parts of earlier versions are of one process
      EXPECT_THAT(record_of(line).processes, testing::Each(0));
    } else if (name == "exposure_ev") {  // they have none either
      EXPECT_EQ(record_of(line).exposure_ev, std::nullopt);
    } else if (name == "frames_per_round") {
      EXPECT_EQ(record_of(line).frames_per_round, 1);
    } else if (name == "cpu_ms" || name == "baseline_cpu_ms") {
      EXPECT_TRUE(record_of(line).cpu_ms.empty());
    } else if (name == "pass_bytes") {
      EXPECT_TRUE(record_of(line).pass_bytes.empty());
    } else if (std::ranges::find(times_by_device, name, [](const auto& t) { return std::string(t.first); }) !=
               std::end(times_by_device)) {  // nor any of these
      EXPECT_THAT(fault_of([&] { record_of(line); }), HasSubstr(" times beside "));
    } else {
      EXPECT_THAT(fault_of([&] { record_of(line); }), HasSubstr(name + " is missing"));
    }
    line[name] = value.is_number() ? nlohmann::json("x") : nlohmann::json(7);
    EXPECT_THAT(fault_of([&] { record_of(line); }), AllOf(HasSubstr(name + ": "), HasSubstr(" is not a")));
  }
  nlohmann::json line = good;
  line["errors"]["total"]["p99_rel"] = true;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "errors.total.p99_rel: true is not a number");
  line = good;
  line["baseline_ms"].push_back(1);
  EXPECT_EQ(fault_of([&] { record_of(line); }), "frame_ms: 3 times beside 4 of baseline_ms");
  line = good;
  line["lights"] = 3e9;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "lights: 3000000000.0 is not a whole number");
  line["lights"] = 3000000000;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "lights: 3000000000 is not a whole number of at least 0");
  line = good;
  line["memory_bytes"] = -1;
  EXPECT_EQ(fault_of([&] { record_of(line); }), "memory_bytes: -1 is not a whole number");
}

TEST(FrontierRecords, OfEarlierVersionsLackMeasuresAndDoNotSayZero) {
  nlohmann::json line = to_json(some_record(8, 0));
  for (const char* later : {"rel_mse", "rel_mse_trimmed", "smape", "smape_trimmed", "energy_rel",
                            "rmse_of_mean", "low_pass_rmse_of_mean", "displayed_flip"})
    ASSERT_EQ(line["errors"]["total"].erase(later), 1u);
  ASSERT_EQ(line["errors"].erase("surfaces"), 1u);
  EXPECT_FALSE(record_of(line).errors.surfaces);
  EXPECT_FALSE(to_json(record_of(line))["errors"].contains("surfaces"));
  const ImageError total = record_of(line).errors.total;
  EXPECT_EQ(total.rmse_rel, some_record(8, 0).errors.total.rmse_rel);
  for (const double ImageError::*later :
       {&ImageError::rel_mse, &ImageError::rel_mse_trimmed, &ImageError::smape, &ImageError::smape_trimmed,
        &ImageError::energy_rel, &ImageError::rmse_of_mean, &ImageError::low_pass_rmse_of_mean})
    EXPECT_TRUE(std::isnan(total.*later));
  EXPECT_FALSE(total.displayed);
}

TEST(FrontierRecords, HaveAKeyOfWhatIsMeasuredAlone) {
  const FrontierRecord r = some_record(8, 1);
  std::set<std::string> keys = {record_key(r)};
  const auto add = [&](auto change) {
    FrontierRecord other = r;
    change(other);
    EXPECT_TRUE(keys.insert(record_key(other)).second) << to_json(other);
  };
  add([](FrontierRecord& o) { o.point.scene = "hall"; });
  add([](FrontierRecord& o) { o.point.technique = "tiled"; });
  add([](FrontierRecord& o) { o.point.settings["tile"] = "16"; });
  add([](FrontierRecord& o) { o.point.frames = 16; });
  add([](FrontierRecord& o) { o.view = 0; });
  add([](FrontierRecord& o) { o.width = 320; });
  add([](FrontierRecord& o) { o.height = 90; });
  add([](FrontierRecord& o) { o.lights = 1023; });
  add([](FrontierRecord& o) { o.radius_scale = 1; });
  add([](FrontierRecord& o) { o.series = "lights"; });
  FrontierRecord measured = r;
  measured.frame_ms.clear();
  measured.errors = {};
  measured.refused = "no";
  measured.image.clear();
  measured.shard = 3;
  EXPECT_EQ(record_key(measured), record_key(r));
  EXPECT_EQ(content_hash(""), "cbf29ce484222325");  // from the authors' test vectors
  EXPECT_EQ(content_hash("foobar"), "85944171f73967e8");
}

}  // namespace
}  // namespace lightgrid::lab
