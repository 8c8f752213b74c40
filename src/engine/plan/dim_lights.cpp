#include "plan/dim_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "plan/instance_boxes.h"
#include "plan/settings/model.h"
#include "plan/settings/picture.h"
#include "plan/settings/shadows.h"
#include "shared/shading_point.h"

namespace lightgrid {
namespace {

constexpr double rounding = 1.001;  // of shading in float

struct Receiver {
  InstanceBox box;
  double reflected = 0;
  double added = 0;  // by lights without shadows: radiance
};

// The light's possible additions to receivers, by their numbers.
using Additions = std::vector<std::pair<size_t, double>>;

Additions additions_of(const GrownLightBounds& reach, const Light& light, const Settings& settings,
                       const std::vector<Receiver>& receivers, const PixelErrors& errors) {
  Additions all;
  for (size_t i = 0; i < receivers.size(); ++i) {
    const Receiver& r = receivers[i];
    const double beside_m = errors.displaced_m(reach, r.box);
    if (r.reflected == 0 || !may_reach(reach.grown(beside_m), r.box)) continue;
    const double nearest_m = distance_to(r.box, reach.light.position) - reach.slack_m - beside_m;
    all.emplace_back(i, rounding * r.reflected *
                            max_irradiance(light, reach.light.radius_m, ranges_of(settings), nearest_m));
  }
  return all;
}

double largest(const Additions& additions) {
  double most = 0;
  for (const auto& [receiver, radiance] : additions) most = std::max(most, radiance);
  return most;
}

}  // namespace

double display_step(double ev) { return 1 / (255 * 12.92 * 1.15 * std::exp2(ev)); }

double max_reflected(const Scene& scene, int instance, Brdf brdf) {
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  const Material& m = scene.materials[size_t(mesh.material)];
  constexpr double unknown = std::numeric_limits<double>::infinity();
  if (m.unlit) return 0;
  if (m.model.skin() || m.model.minnaert() || !mesh.colors.empty()) return unknown;
  const double base = std::max({m.base_color.r, m.base_color.g, m.base_color.b, 0.f});
  const double diffuse = base / std::numbers::pi;
  if (brdf == Brdf::lambert) return diffuse;
  if (brdf == Brdf::blinn || m.clearcoat != 0 || has_specular(m) || base > 1) return unknown;
  const double roughness = m.metallic_roughness_map.texture >= 0 ? 0 : double(m.roughness);
  const double alpha = std::pow(std::max(roughness, double(ROUGHNESS_FLOOR)), 2);
  return diffuse + 1 / (2 * std::numbers::pi * alpha * alpha * alpha);
}

double max_irradiance(const Light& light, double range_m, const LightRanges& ranges, double nearest_m) {
  if (!(nearest_m > 0)) return std::numeric_limits<double>::infinity();
  const double share = std::isinf(range_m) ? 0 : std::min(nearest_m / range_m, 1.0);
  const double khr = 1 - std::pow(share, 4);
  const RangeWindow window = window_of(ranges);
  const double fade = window == RangeWindow::none ? 1 : window == RangeWindow::smooth ? khr * khr : khr;
  return brightest_intensity(light) * fade *
         std::max(1 / (nearest_m * nearest_m), min_falloff(light, ranges));
}

double leave_out_dim_lights(const Scene& scene, const View& view, const Settings& settings,
                            const std::vector<int>& opaque, const std::vector<int>& blended,
                            std::vector<LightShadow>& casting) {
  if (settings[setting::shadow_threshold] == 0 || casting.empty()) return 0;
  if (!settings[setting::display_ev])
    throw input_error(
        "set shadow-threshold: counts steps of the exposed picture, whose exposure is chosen from the "
        "picture itself; give --exposure a number");
  const double step = display_step(*settings[setting::display_ev]),
               most = settings[setting::shadow_threshold] * step;
  const PixelErrors errors(view);
  std::vector<Receiver> receivers;
  double farthest_m = 0;  // from the eye
  for (const auto* instances : {&opaque, &blended}) {
    for (const int i : *instances) {
      Receiver& r = receivers.emplace_back(
          Receiver{box_of(scene, i, view), max_reflected(scene, i, settings[setting::brdf])});
      farthest_m = std::max(farthest_m, farthest_from(r.box, view.eye));
    }
  }
  struct Candidate {
    LightShadow* light;
    Additions additions;
    double largest;
  };
  std::vector<Candidate> candidates;
  for (LightShadow& of : casting) {
    const Light& light = scene.lights[size_t(of.light)];
    if (of.need != ShadowNeed::rays || is_directional(light)) continue;
    // Parts of a shape may be nearer than its position.
    if (lit_term(scene, light, ranges_of(settings), glm::dmat3(1))) continue;
    const LightBounds bounds = bounds_of(light, range_of(light, size_t(of.light), ranges_of(settings)));
    const double slack_m = (farthest_m + glm::length(light.position - view.eye)) * 0x1p-19;
    Additions additions = additions_of({bounds, slack_m}, light, settings, receivers, errors);
    const double of_light = largest(additions);
    if (of_light < most) candidates.push_back({&of, std::move(additions), of_light});
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::largest);
  double added = 0;
  for (const Candidate& c : candidates) {
    const bool fits = std::ranges::all_of(
        c.additions, [&](const auto& to) { return receivers[to.first].added + to.second < most; });
    if (!fits) continue;
    for (const auto& [receiver, radiance] : c.additions)
      added = std::max(added, receivers[receiver].added += radiance);
    c.light->need = ShadowNeed::too_dim;
  }
  return added / step;
}

}  // namespace lightgrid
