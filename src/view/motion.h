// The time of a moving scene: lights by light_motion, and the animations of its file.
#pragma once

#include "scene/animation.h"
#include "scene/light_motion.h"
#include "view/controls.h"

namespace lightgrid {

class Motion {
 public:
  // The scene outlives it; its pose is at `seconds`, or at rest.
  Motion(Scene& scene, LightMotion lights, std::optional<double> seconds);

  // Applies lights, playing, step and seconds of the controls, and clears the last two. Returns what changed
  // in the scene.
  SceneChanges follow(Controls& controls, double seconds_passed);

  double seconds() const { return seconds_.value_or(0); }
  bool can_play() const { return animated_ || rig_.motion != LightMotion::none; }
  bool animated() const { return animated_; }
  // The options of `lightgrid render` for this time; empty at rest.
  std::string words() const;

 private:
  SceneChanges pose();

  Scene& scene_;
  LightRig rig_;
  bool animated_ = false;
  std::optional<double> seconds_;  // empty: at rest, until something plays
};

}  // namespace lightgrid
