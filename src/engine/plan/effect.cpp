#include "plan/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "plan/frame_plan.h"

namespace lightgrid {

std::string words_of(const Effect& effect) {
  std::string words = effect.name;
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string define_of(const Effect& effect) {
  std::string define = std::string("EFFECT_") + effect.name;
  std::ranges::transform(define, define.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return define;
}

EffectNeed need_of_lights(const Scene& scene, const FramePlan& plan, bool (*has_one)(const Light&)) {
  const std::vector<int>& lights = plan.lights.local;
  const auto has = [&](int i) { return has_one(scene.lights[size_t(i)]); };
  const auto first = std::ranges::find_if(lights, has);
  if (first == lights.end()) return {false, "no point or spot light has one"};
  return {true, fmt::format("{} has one; {} of {} lights do", light_witness(scene, *first),
                            std::ranges::count_if(lights, has), lights.size())};
}

std::string missing_oracle(const Effect& effect, std::span<const std::string> keys_that_mean) {
  if (!effect.base && !effect.reach && !effect.lit)
    return "it answers no hook: give .base, .reach or .lit with its oracle";
  if (effect.lit && !effect.lit->term) return "lit has no oracle: give .term";
  if (effect.reach && !has_masks(effect) && (!effect.reach->term || !effect.reach->share))
    return "reach has no oracle: give .term and .share, or .masks";
  if (effect.background && (!effect.base || !effect.background->term))
    return "background has no oracle: give .term, and .base, whose inputs it reads";
  if (!effect.base || effect.base->term) return "";
  if (!effect.base->meant_by) return "base has no oracle: give .term, or .meant_by with a setting's key";
  const bool means = std::ranges::count(keys_that_mean, std::string(effect.base->meant_by)) > 0;
  return means ? "" : std::string("base is meant by ") + effect.base->meant_by + ", which has no .mean";
}

const Effect* background_effect(const FramePlan& plan) {
  const auto found =
      std::ranges::find_if(plan.effects, [](const Effect* e) { return e->background.has_value(); });
  return found == plan.effects.end() ? nullptr : *found;
}

BackgroundTerm background_term(const Scene& scene, const View& view, const FramePlan& plan) {
  if (const Effect* effect = background_effect(plan)) return effect->background->term(scene, view);
  return [color = glm::dvec3(scene.background)](const glm::dvec3&) { return color; };
}

std::vector<BaseTerm> base_terms(const Scene& scene, const View& view, const FramePlan& plan) {
  std::vector<BaseTerm> terms;
  for (const Effect* effect : plan.effects) {
    if (effect->base && effect->base->term) terms.push_back(effect->base->term(scene, view, plan.settings));
  }
  return terms;
}

}  // namespace lightgrid
