// State of a view that passes and effects keep from frame to frame, besides targets and programs.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cl/launch.h"
#include "plan/effect.h"

namespace lightgrid {

struct PassContext;

using EffectFigures = std::map<std::string, double>;  // by key

class PassCache {
 public:
  virtual ~PassCache() = default;
  virtual size_t memory_bytes() const { return 0; }
  // Called after the camera, the lights or the plan changed. Returns false if the cache no longer fits; it is
  // then made again at its next use.
  virtual bool follow(PassContext&) { return false; }
  // Uploads that follow() may leave for later, as the rasteriser does not read them. PassCaches::upload calls
  // it while the device draws triangles; the pass calls it too, before it reads them. Only the first call
  // after follow() does anything.
  virtual void upload(PassContext&) {}
};

// An effect's memory. It fills its inputs (renderer/loop_inputs.h), which light loops then read.
class EffectState : public PassCache {
 public:
  virtual void before_lights(PassContext& work) = 0;   // at the beginning of each frame
  virtual void bind() const = 0;                       // the inputs of shaders
  virtual ClArguments base_arguments() { return {}; }  // of kernels: EFFECT_PARAMETERS of the hook NAME_base,
  // And of the hooks for lights: NAME_reach, NAME_tint, NAME_meets, and their values of surfaces.
  virtual ClArguments reach_arguments() { return {}; }
  virtual EffectFigures figures() const { return {}; }  // of the last frame, for results.json and results.csv
};

// The effects' states of a view, in the order of its plan.
class EffectStates {
 public:
  void before_lights(PassContext& work);  // makes the planned states that are missing
  void bind() const;
  ClArguments base_arguments();
  ClArguments reach_arguments();
  std::map<std::string, EffectFigures> figures() const;  // by the effect's name, of those that have any
  EffectState* find(const Effect& effect) const;         // null: none

  void follow(PassContext& work);  // drops those that the plan no longer has, or that no longer fit
  void clear() { states_.clear(); }
  size_t memory_bytes() const;

 private:
  struct State {
    const Effect* effect;
    std::unique_ptr<EffectState> state;
  };
  ClArguments all(ClArguments (EffectState::*of)());

  std::vector<State> states_;
};

}  // namespace lightgrid
