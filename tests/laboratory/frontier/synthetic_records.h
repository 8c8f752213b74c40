// Records of a frontier without rendering: plausible figures whose answer is known.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "frontier/answer.h"

namespace lightgrid::lab {

using SettingMap = std::map<std::string, std::string>;

inline FrontierPoint synthetic_point(const std::string& scene, const std::string& technique,
                                     const SettingMap& settings = {}) {
  FrontierPoint point{scene, technique, settings, technique};
  for (const auto& [key, value] : settings) {
    point.label += (point.label == technique ? ":" : ",") + key + "=" + value;
  }
  return point;
}

inline ImageError synthetic_error(double max_rel, double rmse_rel, double relative_rmse, double p99_rel,
                                  std::optional<double> flip_mean = {}) {
  return {.max_rel = max_rel,
          .flip_mean = flip_mean,
          .rmse_rel = rmse_rel,
          .p99_rel = p99_rel,
          .relative_rmse = relative_rmse};
}

// `runs` runs: the baseline takes 100 ms, the point `ratio` times that, alternately 1 % less and more. Its
// error is all of the model.
inline FrontierRecord synthetic_record(const FrontierPoint& point, double ratio, double error, int view = 0,
                                       int runs = 10) {
  FrontierRecord record;
  record.point = point;
  record.view = view;
  record.width = 64;
  record.height = 36;
  record.lights = 100;
  for (int run = 0; run < runs; ++run) {
    record.baseline_ms.push_back(100);
    record.frame_ms.push_back(100 * ratio * (1 + (run % 2 ? 0.01 : -0.01) * (1 + run) / runs));
  }
  record.errors.total = synthetic_error(2 * error, error, error, error);
  record.errors.total.displayed = DisplayedFlip{error, 0};
  record.errors.model = record.errors.total;
  record.memory_bytes = 1 << 20;
  record.bytes_moved = 1000;
  record.covered_pixels = 64 * 36;
  record.pairs = {1000, 500, 0, 0};
  return record;
}

inline FrontierPart synthetic_part(std::vector<FrontierRecord> records) {
  FrontierPart part;
  part.request = "request";
  part.commit = "0123abc";
  part.baseline = "forward_plus";
  part.machine.cl_device = "pthread-Intel Xeon";
  part.machine.gl_device = "AMD Radeon RX 7900";
  part.machine.cl_driver = "3.1";
  part.machine.gl_driver = "22.3.6";
  part.machine.cpu = "Intel Xeon <2 cores>";
  part.machine.governor = "unknown";
  part.machine.clock_mhz = 2100;
  part.machine.threads = 2;
  part.machine.load_at_start = 0.2;
  part.machine.load_at_end = 1.9;
  part.records = std::move(records);
  return part;
}

inline FrontierAnswer answer_from(std::vector<FrontierRecord> records) {
  return answer_of({synthetic_part(std::move(records))});
}

// Two scenes of two views, every kind of figure. In hall, by ratio and error: visibility (0.3, 1e-4), its
// cutoff (0.2, 1e-2), forward_plus (1, 1e-4) with cull tests, deferred (0.5, 0: no error), clustered (0.301,
// 1e-4: tied with visibility), lidr (0.25, 2e-2) loses lights, forward is refused, forward_plus with 8-pixel
// tiles shows NaN.
inline FrontierPart synthetic_sweep() {
  std::vector<FrontierRecord> records;
  for (const std::string scene : {"scenes/hall.glb", "terrain"}) {
    for (int view = 0; view < 2; ++view) {
      const auto add = [&](const std::string& technique, const SettingMap& settings, double ratio,
                           double error) -> FrontierRecord& {
        records.push_back(synthetic_record(synthetic_point(scene, technique, settings), ratio, error, view));
        return records.back();
      };
      const auto culled = [&](FrontierRecord& record, double cull_ms, uint64_t listed) {
        record.pass_ms = {{"cull_lights", cull_ms}, {"shade_forward", 10 + 4e-6 * double(listed)}};
        record.pairs = {listed, 200000, 0, 0};
      };
      culled(add("forward_plus", {{"cull_test", "planes+aabb"}}, 1, 1e-4), 2, 1600000);
      records.back().point.label = "forward_plus";
      culled(add("forward_plus", {{"cull_test", "exact"}}, 0.9, 1e-4), 5, 1000000);
      culled(add("forward_plus", {{"cull_test", "sphere"}}, 1.4, 1e-4), 1.5, 3000000);
      add("visibility", {{"range", "scene"}}, 0.3, 1e-4).image =
          scene == "terrain" ? "terrain-visibility" : "hall-visibility";
      add("visibility", {{"range", "cutoff"}, {"cutoff", "0.01"}}, 0.2, 1e-2);
      add("clustered", {}, 0.301, 1e-4);
      add("deferred", {}, 0.5, 0);
      add("lidr", {}, 0.25, 2e-2).pairs.lost = 812;
      add("forward_plus", {{"cull_test", "planes+aabb"}, {"tile", "8"}}, 0.1, std::nan("")).nan_pixels = 3;
      FrontierRecord refused;
      refused.point = synthetic_point(scene, "forward");
      refused.view = view;
      refused.refused = "shading <every> light would take 20 minutes";
      records.push_back(refused);
    }
    for (const int lights : {10, 100, 1000, 10000}) {
      for (const std::string technique : {"forward", "forward_plus"}) {
        FrontierRecord record = synthetic_record(synthetic_point(scene, technique), 1, 0);
        record.series = "lights";
        record.lights = lights;
        for (double& ms : record.frame_ms)
          ms = technique == "forward" ? 0.01 * lights : 5 * std::sqrt(lights) * (lights == 100 ? 1.1 : 1);
        records.push_back(record);
      }
    }
  }
  return synthetic_part(std::move(records));
}

}  // namespace lightgrid::lab
