// An effect that adds to what surfaces show: its name, whether a frame needs it, and what it keeps for a
// view. src/effects has one file for each, shared/effects the text that kernels and shaders read.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lightgrid {

struct Scene;
struct FramePlan;
struct Work;
struct LightReader;  // scene/light_readers.h
class EffectState;   // renderer/effect_state.h

struct EffectNeed {
  bool needed = false;
  std::string why;  // the witness, or why not
};

struct Effect {
  const char* name;  // of its files: "far_light"
  // Called after the plan has the lights. Must depend on the scene and the settings only, so that a camera
  // that turns compiles nothing. Returns none if the settings leave the effect out: the plan does not mention
  // it.
  std::optional<EffectNeed> (*decide)(const Scene&, const FramePlan&);
  std::unique_ptr<EffectState> (*make)(Work&);
  const LightReader* reader = nullptr;  // what it reads of lights, if it does
};

using Effects = std::span<const Effect* const>;

// Its name in a plan ("far light"), and the define of programs that have it ("EFFECT_FAR_LIGHT").
std::string words_of(const Effect& effect);
std::string define_of(const Effect& effect);

}  // namespace lightgrid
