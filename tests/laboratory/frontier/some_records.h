// Records and parts with a different value in each field.
#pragma once

#include "frontier/answer.h"

namespace lightgrid::lab {

inline ImageError some_figures(double scale) {
  return {.max_rel = 0.1 * scale,
          .rmse_rel = scale / 3,
          .p99_rel = 0.011 * scale,
          .relative_rmse = 0.07 * scale,
          .rel_mse = 0.5 * scale,
          .rel_mse_trimmed = 0.25 * scale,
          .smape = 0.125 * scale,
          .smape_trimmed = 0.0625 * scale,
          .energy_rel = -0.75 * scale,
          .rmse_of_mean = 1.5 * scale,
          .low_pass_rmse_of_mean = 0.375 * scale};
}

// The record of view `view` of a point whose tile is `tile`.
inline FrontierRecord some_record(int tile, int view) {
  FrontierRecord r;
  r.point.scene = "scenes/\"Sponza\", großer\n.glb";
  r.point.technique = "forward_plus";
  r.point.settings = {{"tile", std::to_string(tile)}, {"cull_test", "planes+aabb"}};
  r.point.label = "forward_plus:tile=" + std::to_string(tile);
  r.point.frames = 4;
  r.view = view;
  r.width = 160;
  r.height = 91;
  r.lights = 1024;
  r.radius_scale = 1.5;
  r.frame_ms = {1.25 + view, 1.0 / 3, 2.5};
  r.baseline_ms = {2.5, 2.0 / 3 + view, 5};
  r.device_ms = {0.5, 0.25, 1.0 / 7};
  r.baseline_device_ms = {1.5, 1, 1.25};
  r.hand_over_ms = {0, 0.125, 0};
  r.copy_ms = {0.01, 0, 0};
  r.read_back_ms = {0.3, 0.2, 0.1};
  r.processes = {0, 0, 1};
  r.pass_ms = {{"cull_lights", 0.1}, {"shade_forward", 0.7}};
  r.bytes_moved = 18446744073709551615u;
  r.memory_bytes = 9007199254740993u;  // not a double
  r.covered_pixels = 14000;
  r.pairs = {1000, 400, 2, 1};
  r.nan_pixels = 3;
  r.overflow = 5;
  r.cull_ms = {0.1, 0.125, 1.0 / 7};
  r.errors = {.model = some_figures(1),
              .precision = some_figures(2),
              .technique = some_figures(3),
              .total = some_figures(4),
              .in_double = SampledErrors{9000, some_figures(5), some_figures(7), some_figures(6)},
              .bias_rmse_rel = 1e-5,
              .deviation_rmse_rel = 2e-5};
  r.errors.total.flip_mean = 0.0123;
  r.errors.total.displayed = DisplayedFlip{0.03125, 0.1875};
  r.errors.authored = AuthoredErrors{some_figures(8), some_figures(9)};
  r.errors.authored->total.displayed = DisplayedFlip{0.015625, 0.125};
  r.errors.seeds = SeedErrors{32, 8, some_figures(10), 4e-10, 1e-10};
  r.errors.seeds->deviation.displayed = DisplayedFlip{0.5, 0.25};
  r.errors.temporal_rmse_rel = 3e-5;
  double figure = 1.0 / 256;
  for (SequenceError SequenceErrors::*sequence :
       {&SequenceErrors::still, &SequenceErrors::dolly, &SequenceErrors::moving_lights}) {
    if (!r.errors.sequences) r.errors.sequences.emplace();
    for (SequenceFigures SequenceError::*of : {&SequenceError::plain, &SequenceError::filtered}) {
      SequenceFigures& figures = (*r.errors.sequences).*sequence.*of;
      for (double* value : {&figures.flicker.mean, &figures.flicker.visible, &figures.largest_flicker,
                            &figures.displayed.mean, &figures.displayed.visible})
        *value = figure += 1.0 / 256;
    }
  }
  r.errors.surfaces = some_figures(11);
  r.errors.surfaces->displayed = DisplayedFlip{0.0625, 0.375};
  r.flip = FlipExposures{-2.5, 7.25, 10};
  r.exposure_ev = -1.5;
  r.image = "sponza_17";
  return r;
}

inline FrontierPart some_part(int shard = 1, int shards = 4) {
  FrontierPart part;
  part.request = "0123456789abcdef";
  part.commit = "9d11b69";
  part.seed = 18446744073709551615u;
  part.shard = shard;
  part.shards = shards;
  part.baseline = "forward_plus";
  part.machine = {.cl_device = "cpu-haswell",
                  .gl_device = "llvmpipe",
                  .cl_driver = "PoCL 3.1",
                  .gl_driver = "Mesa 22.3.6",
                  .cpu = "Xeon",
                  .governor = "unknown",
                  .clock_mhz = 2600,
                  .threads = 2,
                  .load_at_start = 0.25};
  return part;
}

inline PointFigures some_point_figures(int tile) {
  PointFigures p;
  p.point = some_record(tile, 0).point;
  p.views = 2;
  p.width = 160;
  p.height = 91;
  p.frame_ms = {2.5, 2.25, 3, 8};
  p.p95_ms = 4;
  p.p99_ms = 5;
  p.relative_time = {.estimate = 0.5, .low = 0.25, .high = 0.75, .runs = 8, .processes = 2};
  p.relative_time.between_processes = 0.125;
  p.errors = some_record(tile, 0).errors;
  p.exposure_ev = -1.5;
  p.flip_views = 2;
  p.temporal_views = 1;
  p.pairs = {2000, 800, 4, 2};
  p.memory_bytes = 5000;
  p.bytes_moved = 7000;
  p.nan_pixels = 6;
  p.fronts["total"] = {tile == 8, 0.875};
  return p;
}

// Two points of two views each, one of them refused beside them.
inline FrontierAnswer some_answer() {
  FrontierAnswer answer;
  answer.part = some_part();
  for (const int tile : {8, 16}) {
    for (const int view : {0, 1}) answer.part.records.push_back(some_record(tile, view));
  }
  for (FrontierRecord& record : answer.part.records) record.shard = 1;
  FrontierRecord refused = some_record(32, 0);
  refused.point.scene = "hall";
  refused.refused = "needs \"OpenGL\", which is not here";
  refused.frame_ms.clear();
  refused.baseline_ms.clear();
  answer.part.records.push_back(refused);
  answer.machines = {answer.part.machine, answer.part.machine};
  answer.machines[0].shard = 1;
  answer.machines[1].shard = 2;
  answer.machines[1].cl_device = "another";
  answer.points = {some_point_figures(8), some_point_figures(16)};
  answer.cheapest_within = {
      {answer.points[0].point.scene, "total", 1e-3, 0, answer.points[0].relative_time, 0.5}};
  answer.controls = {
      {answer.points[0].point.scene, {.estimate = 1.0625, .low = 1, .high = 1.125, .runs = 8}, {1, 1.125}}};
  answer.front_bands = {{answer.points[0].point.scene, "total", {{1e-3, 0.25, 0.75}}}};
  answer.break_even = {{"hall", "exact", "sphere", 0.25, 1.5, 1000, 0.125, 0.5, 12}};
  answer.shading_costs = {{"hall", "forward_plus", "ggx", 0.75, 0.5, 1}};
  answer.growth = {{"hall", "forward_plus", "lights", 0.5, 0.25, 0.75, {{100, 1}, {400, 2}, {1600, 4}}}};
  answer.failures = {{refused.point, "refused", "refused: " + refused.refused}};
  answer.sentences = {"One.", "Two."};
  return answer;
}

}  // namespace lightgrid::lab
