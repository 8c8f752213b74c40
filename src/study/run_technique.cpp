#include "study/run_technique.h"

#include "gl/errors.h"
#include "gl/state.h"
#include "study/metrics.h"

namespace lightgrid {

TechniqueRun::TechniqueRun(Devices& devices, const Scene& scene, const View& view, const Settings& settings,
                           const Technique& technique)
    : technique_(technique), frame_(devices, scene, view, plan_frame(scene, view, settings, technique.needs)) {}

void TechniqueRun::render() {
  reset_gl_state();
  read_back(frame_, technique_.render(frame_), image_);
  check_gl(technique_.name);
}

void TechniqueRun::run_frame(bool warmup) {
  const Timer timer;
  render();
  if (!warmup) frame_ms_.push_back(timer.elapsed_ms());
}

void TechniqueRun::run_profiled_frames() {
  const Timer timer;
  frame_.timer.enabled = true;
  for (int i = 0; i < 5 && (i == 0 || timer.elapsed_ms() < 1000); ++i) {
    render();
  }
  frame_.timer.enabled = false;
}

RunResult TechniqueRun::result() const {
  RunResult result;
  result.technique = technique_.name;
  result.settings = settings_of(technique_, frame_.plan.settings);
  result.lights_total = int(frame_.scene.lights.size());
  result.lights_in_view = frame_.plan.lights_in_view;
  result.frame_ms = spread_of(frame_ms_);
  for (const PassRecord& record : frame_.timer.records()) {
    result.passes.push_back({record.name, record.on, spread_of(record.ms).median, record.bytes_read, record.bytes_written});
  }
  result.memory_total = frame_.memory_bytes();
  result.memory_light_grid = frame_.light_grid_bytes();
  result.memory_gbuffer = frame_.targets.bytes(TargetUse::gbuffer);
  result.nan_pixels = count_nan_pixels(image_);
  result.inf_pixels = count_inf_pixels(image_);
  for (const Decision& decision : frame_.plan.decisions) {
    if (!decision.needed) result.skipped.push_back({decision.effect, decision.why});
  }
  return result;
}

}  // namespace lightgrid
