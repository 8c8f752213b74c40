#include "renderer/effect_state.h"

#include <algorithm>

#include "renderer/pass_context.h"

namespace lightgrid {

void EffectStates::before_lights(PassContext& work) {
  std::vector<State> planned;
  for (const Effect* effect : work.plan.effects) {
    const auto made = std::ranges::find(states_, effect, &State::effect);
    planned.push_back({effect, made == states_.end() ? effect->make(work) : std::move(made->state)});
  }
  states_ = std::move(planned);
  for (const State& s : states_) s.state->before_lights(work);
}

void EffectStates::bind() const {
  for (const State& s : states_) s.state->bind();
}

ClArguments EffectStates::all(ClArguments (EffectState::*of)()) {
  ClArguments arguments;
  for (const State& s : states_) arguments = std::move(arguments) + (*s.state.*of)();
  return arguments;
}

ClArguments EffectStates::base_arguments() { return all(&EffectState::base_arguments); }
ClArguments EffectStates::reach_arguments() { return all(&EffectState::reach_arguments); }

std::map<std::string, EffectFigures> EffectStates::figures() const {
  std::map<std::string, EffectFigures> figures;
  for (const State& s : states_) {
    if (EffectFigures own = s.state->figures(); !own.empty()) figures[s.effect->name] = std::move(own);
  }
  return figures;
}

EffectState* EffectStates::find(const Effect& effect) const {
  const auto made = std::ranges::find(states_, &effect, &State::effect);
  return made == states_.end() ? nullptr : made->state.get();
}

void EffectStates::follow(PassContext& work) {
  std::erase_if(states_, [&](State& s) {
    return std::ranges::count(work.plan.effects, s.effect) == 0 || !s.state->follow(work);
  });
}

size_t EffectStates::memory_bytes() const {
  size_t bytes = 0;
  for (const State& s : states_) bytes += s.state->memory_bytes();
  return bytes;
}

}  // namespace lightgrid
