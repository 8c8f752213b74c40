#include "plan/sample_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

// Names the shadows that are found for only one sample per pixel, if there are any here.
const char* shadows_of_one_sample(bool opengl, bool stored, const ShadowPlan& shadows, const Settings& s) {
  if (!shadows.light_reaches && !shadows.own) return nullptr;
  return opengl                                     ? "shadows where OpenGL draws"
         : stored                                   ? "shadows of stored surfaces"
         : s[setting::shadows] == ShadowMethod::map ? "shadow maps"
         : soft_shadows(s)                          ? "shadows of shadow-rays"
         : picks_shadows(s)                         ? "shadows of shadow-pick"
                                                    : nullptr;
}

// Why one sample per pixel is drawn, although the scene requests more; empty: they are drawn. The same for
// every view of the scene.
std::string why_one_sample(const Scene& scene, const SampleNeeds& needs, bool opengl,
                           const char* of_one_sample, const Settings& settings) {
  if (settings.given(setting::samples)) return fmt::format("samples={}", settings[setting::samples]);
  if (scene.samples > needs.most)
    return fmt::format("the technique with these settings takes {}", needs.most);
  if (opengl && !needs.opengl) return "OpenGL on this machine cannot draw them";
  return of_one_sample ? fmt::format("{} are found for one", of_one_sample) : "";
}

void plan_masks(const Scene& scene, const SurfacePlan& surfaces, const Settings& settings,
                Decisions& decisions) {
  const auto masked = std::ranges::find_if(
      surfaces.opaque, [&](int i) { return (surfaces.features_of_instance[size_t(i)] & feature_mask) != 0; });
  const bool at_samples = settings[setting::samples_masks] != SampleMasks::centre;
  decisions.push_back({"masks of samples", at_samples && masked != surfaces.opaque.end(),
                       !at_samples                       ? "samples-masks=centre"
                       : masked == surfaces.opaque.end() ? "no masked material in view"
                                                         : instance_witness(scene, *masked)});
}

}  // namespace

void plan_samples(const Scene& scene, const SampleNeeds& needs, bool opengl, bool stored,
                  const SurfacePlan& surfaces, const ShadowPlan& shadows, Settings& settings,
                  Decisions& decisions) {
  const char* of_one_sample = shadows_of_one_sample(opengl, stored, shadows, settings);
  int samples = settings[setting::samples];
  if (samples > 1) {
    decisions.push_back({"samples", true, fmt::format("samples={}", samples)});
  } else if (scene.samples > 1) {
    const std::string why_one = why_one_sample(scene, needs, opengl, of_one_sample, settings);
    if (why_one.empty()) {
      samples = scene.samples;
      settings.set(setting::samples, samples);
    }
    decisions.push_back({"samples", why_one.empty(),
                         fmt::format("the scene asks for {} samples per pixel{}{}", scene.samples,
                                     why_one.empty() ? "" : "; ", why_one)});
  }
  if (samples == 1) return;
  plan_masks(scene, surfaces, settings, decisions);
  if (!of_one_sample) return;
  const auto caster = std::ranges::find_if(scene.lights, &Light::casts_shadow);
  throw input_error(
      "set samples={}: light {} \"{}\" casts a shadow, and {} are found for one sample a "
      "pixel; choose samples=1 or shadows=none",
      samples, caster - scene.lights.begin(), caster->name, of_one_sample);
}

}  // namespace lightgrid
