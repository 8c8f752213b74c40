#include "run/stage_figures.h"

#include "plan/settings/kernels.h"

namespace lightgrid {

static std::optional<ShadowResult> shadow_result(const FramePlan& plan, const Frame& frame) {
  if (plan.shadows.casting.empty()) return {};
  ShadowResult result;
  bool unchanged = false;
  if (frame.shadow_figures) {
    const ShadowFigures figures = frame.shadow_figures();
    result.lights = figures.lights;
    result.maps = figures.maps;
    result.drawn = figures.drawn;
    result.kept = figures.kept;
    result.bytes = figures.bytes;
    result.rays = figures.rays;
    result.undecided = figures.undecided;
    result.halvings = figures.halvings;
    result.bands = figures.bands;
    result.tiles_kept = figures.tiles_kept;
    unchanged = figures.unchanged;
  }
  result.dim_steps = plan.shadows.dim_steps;
  if (plan.settings[setting::everything_on]) return result;
  for (const LightShadow& light : plan.shadows.casting) {
    const bool needed = light.need == ShadowNeed::rays;
    if (!needed || unchanged)
      result.skipped.push_back({light.light, needed ? unchanged_reason : reason_of(light.need)});
  }
  return result;
}

static std::optional<SampleResult> sample_result(const Frame& frame) {
  if (!frame.sample_figures) return {};
  const SampleFigures f = frame.sample_figures();
  return SampleResult{f.edge_pixels, f.shadings, f.covered, f.bytes};
}

void add_stage_figures(const FramePlan& plan, const Frame& frame, FrameFigures& figures) {
  figures.shadows = shadow_result(plan, frame);
  figures.samples = sample_result(frame);
}

}  // namespace lightgrid
