#include <fmt/format.h>

#include <algorithm>

#include "plan/light_shadows.h"

namespace lightgrid {

const char* reason_of(ShadowNeed need) {
  switch (need) {
    case ShadowNeed::rays:
      break;
    case ShadowNeed::no_caster:
      return "no caster in its range";
    case ShadowNeed::no_receiver:
      return "no receiver in view within its range";
    case ShadowNeed::casters_behind:
      return "casters only behind all receivers";
    case ShadowNeed::left_out:
      return "has a shadow that this setting leaves out";
    case ShadowNeed::too_dim:
      return "adds too little to the display here (shadow-threshold)";
  }
  return "";
}

std::string words_of(const LightShadow& light, const Scene& scene) {
  if (light.need != ShadowNeed::rays) return reason_of(light.need);
  return fmt::format("reaches node {} \"{}\"", light.caster, scene.instances[size_t(light.caster)].name);
}

std::string describe_shadows(const std::vector<LightShadow>& casting, const Scene& scene,
                             const char* found_by) {
  std::string text;
  for (const ShadowNeed need : {ShadowNeed::rays, ShadowNeed::no_caster, ShadowNeed::no_receiver,
                                ShadowNeed::casters_behind, ShadowNeed::left_out, ShadowNeed::too_dim}) {
    const auto count = std::ranges::count(casting, need, &LightShadow::need);
    if (count == 0) continue;
    const LightShadow& first = *std::ranges::find(casting, need, &LightShadow::need);
    text += fmt::format("    {:>6} {}: light {} \"{}\"", count,
                        need == ShadowNeed::rays ? found_by : reason_of(need), first.light,
                        scene.lights[size_t(first.light)].name);
    if (need == ShadowNeed::rays) text += " " + words_of(first, scene);
    text += count > 1 ? ", …\n" : "\n";
  }
  return text.empty() ? text : fmt::format("  lights that cast shadows: {}\n", casting.size()) + text;
}

}  // namespace lightgrid
