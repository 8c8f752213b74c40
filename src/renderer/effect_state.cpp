#include "renderer/effect_state.h"

#include <algorithm>

#include "renderer/work.h"

namespace lightgrid {

void EffectStates::before_lights(Work& work) {
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

ClArguments EffectStates::arguments() {
  ClArguments arguments;
  for (const State& s : states_) arguments = std::move(arguments) + s.state->arguments();
  return arguments;
}

EffectState* EffectStates::find(const Effect& effect) const {
  const auto made = std::ranges::find(states_, &effect, &State::effect);
  return made == states_.end() ? nullptr : made->state.get();
}

void EffectStates::follow(Work& work) {
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
