#include "effects/effects.h"

namespace lightgrid {

extern const Effect area_lights, environment_light, far_light, light_cookies, light_groups, light_hulls,
    light_profiles;

static constexpr const Effect* effects[] = {&area_lights,  &environment_light, &far_light,     &light_cookies,
                                            &light_groups, &light_hulls,       &light_profiles};
constinit const Effects all_effects = effects;

// Lights are read with the effects' part in them (scene/effect_terms.h).
[[maybe_unused]] static const bool registered = [] {
  std::vector<ReachOracle> reach;
  std::vector<LitOracle> lit;
  for (const Effect* effect : effects) {
    if (effect->reach) reach.push_back(*effect->reach);
    if (effect->lit) lit.push_back(*effect->lit);
  }
  set_light_oracles(std::move(reach), std::move(lit));
  return true;
}();

}  // namespace lightgrid
