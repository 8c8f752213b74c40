// The time of a scene that moves: lights by light_motion, and the animations of its file.
#pragma once

#include "scene/animation.h"
#include "scene/light_motion.h"
#include "view/controls.h"

namespace lightgrid {

class Motion {
 public:
  // The scene outlives it; it is at `seconds` of its animations.
  Motion(Scene& scene, LightMotion lights, double seconds);

  // Takes lights, playing, step and seconds of the controls, and clears the last two. Returns what changed in
  // the scene.
  SceneChanges follow(Controls& controls, double seconds_passed);

  double seconds() const { return seconds_; }
  bool can_play() const { return animated_ || rig_.motion != LightMotion::none; }
  bool animated() const { return animated_; }
  // The options of `lightgrid render` that give this moment; empty at rest.
  std::string words() const;

 private:
  SceneChanges pose();

  Scene& scene_;
  LightRig rig_;
  bool animated_ = false;
  double seconds_ = 0;
};

}  // namespace lightgrid
