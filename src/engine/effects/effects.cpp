#include "effects/effects.h"

namespace lightgrid {

extern const Effect environment_light, far_light, light_cookies, light_groups, light_hulls, light_profiles;

static constexpr const Effect* effects[] = {&environment_light, &far_light,   &light_cookies,
                                            &light_groups,      &light_hulls, &light_profiles};
constinit const Effects all_effects = effects;

// Lights are read with the effects' part in them (scene/effect_terms.h).
[[maybe_unused]] static const bool registered = [] {
  std::vector<ReachOracle> oracles;
  for (const Effect* effect : effects) {
    if (effect->reach) oracles.push_back(*effect->reach);
  }
  set_reach_oracles(std::move(oracles));
  return true;
}();

}  // namespace lightgrid
