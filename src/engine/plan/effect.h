// An effect: its name, whether a frame needs it, what it keeps for a view, and the oracle of each hook that
// its text answers. src/engine/effects has one file for each, shared/effects the text that kernels and
// shaders read.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/effect_terms.h"

namespace lightgrid {

struct FramePlan;
class Settings;
struct View;
struct Surface;  // scene/surface.h
struct PassContext;
struct LightReader;  // scene/light_readers.h
class EffectState;   // renderer/effect_state.h

struct EffectNeed {
  bool needed = false;
  std::string why;    // the witness, or why not
  bool idles = true;  // where it is not needed, it changes no bit of the picture: everything-on turns it on
};

// For an effect of point and spot lights that have something: needed if one of the plan's lights has it.
EffectNeed need_of_lights(const Scene& scene, const FramePlan& plan, bool (*has_one)(const Light&));

// The radiance that an effect adds to a surface at this point of view space.
using BaseTerm = std::function<glm::dvec3(const Surface&, const glm::dvec3& position)>;

// The hook NAME_base: the same in double, or the key of the setting whose `.mean` takes the effect's place in
// the picture that is meant.
struct BaseOracle {
  BaseTerm (*term)(const Scene&, const View&, const Settings&) = nullptr;
  const char* meant_by = nullptr;
};

// The radiance that is seen past all surfaces in a direction from the eye, in view space.
using BackgroundTerm = std::function<glm::dvec3(const glm::dvec3& direction)>;

// The hook NAME_background. At most one effect has it.
struct BackgroundOracle {
  BackgroundTerm (*term)(const Scene&, const View&) = nullptr;
};

struct Effect {
  const char* name;  // of its files: "far_light"
  // Called after the plan has the lights. Must depend on the scene and the settings only, so that a camera
  // that turns compiles nothing. Returns none if the settings leave the effect out: the plan does not mention
  // it.
  std::optional<EffectNeed> (*decide)(const Scene&, const FramePlan&);
  std::unique_ptr<EffectState> (*make)(PassContext&);
  // The hooks that its text answers. ReachOracle is that of NAME_meets, too.
  std::optional<BaseOracle> base{};
  std::optional<BackgroundOracle> background{};  // of an effect with `base`, whose inputs it reads
  std::optional<ReachOracle> reach{};
  std::optional<LitOracle> lit{};
  const LightReader* reader = nullptr;  // what it reads of lights, if it does
};

using Effects = std::span<const Effect* const>;

// Its name in a plan ("far light"), and the define of programs that have it ("EFFECT_FAR_LIGHT").
std::string words_of(const Effect& effect);
std::string define_of(const Effect& effect);
inline bool has_masks(const Effect& effect) { return effect.reach && effect.reach->masks.of_light; }

// Lists the hooks of an effect that have no oracle: "base has no oracle: ..."; empty if nothing is missing.
// `keys_that_mean`: keys of the settings with `.mean`.
std::string missing_oracle(const Effect& effect, std::span<const std::string> keys_that_mean);

// The planned effect that has a background; null: the scene's.
const Effect* background_effect(const FramePlan& plan);

// The scene's background, or the effect's.
BackgroundTerm background_term(const Scene& scene, const View& view, const FramePlan& plan);

// The terms of planned effects that add to the light of surfaces.
std::vector<BaseTerm> base_terms(const Scene& scene, const View& view, const FramePlan& plan);

}  // namespace lightgrid
