// The window's clocks: the time of a moving scene, the size of the picture that holds a frame rate, and the
// times of passes.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "renderer/pass_timer.h"
#include "scene/animation.h"
#include "scene/light_motion.h"
#include "view/controls.h"

namespace lightgrid::app {

// Lights by light_motion, and the animations of the scene's file.
class Motion {
 public:
  // The scene outlives it; its pose is at `seconds`, or at rest.
  Motion(Scene& scene, LightMotion lights, std::optional<double> seconds);

  // Applies lights, playing, step and seconds of the controls, and clears the last two. Returns what changed
  // in the scene.
  SceneChanges follow(Controls& controls, double seconds_passed);

  double seconds() const { return seconds_.value_or(0); }
  LightMotion lights() const { return rig_.motion; }
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

// The size of the picture while something moves.
class Resolution {
 public:
  // `starts_small`: as if something moved just now, at half the size until a time is known.
  explicit Resolution(bool starts_small = false)
      : fraction_(starts_small ? 0.5 : 1), since_move_s_(starts_small ? 0 : seconds_to_rest) {}

  // The fraction of the picture's width and height to draw: 1 at rest, and if `rate` (frames a second) is 0.
  // `moving`: something moved in this frame. It is at rest `seconds_to_rest` after its last move.
  double next(bool moving, double seconds, double rate);
  bool resting() const { return since_move_s_ >= seconds_to_rest; }
  // Time of a frame drawn at the fraction from the last next(), without compiling, and that of the window's
  // own work in it, which does not depend on the fraction.
  void measured(double frame_ms, double window_ms = 0);

  static constexpr double seconds_to_rest = 0.15;

 private:
  double fraction_;     // while moving
  double full_ms_ = 0;  // estimate for a full picture; 0: not measured yet
  double window_ms_ = 0;
  double since_move_s_;
  double drawn_ = 1;
};

struct PassMs {
  std::string name;
  double ms = 0;
};

struct FrameTimes {
  std::vector<PassMs> passes;  // in order of execution
  double total_ms() const;
};

// Frame times of one side, the last ones.
class Timings {
 public:
  static constexpr size_t kept_frames = 120;

  void add(FrameTimes frame);
  const std::deque<FrameTimes>& frames() const { return frames_; }  // the last one last
  // The mean of each pass over the last frames, up to `count`, in the order of the last frame.
  FrameTimes mean(size_t count) const;
  void clear() { frames_.clear(); }

 private:
  std::deque<FrameTimes> frames_;
};

// The times of one frame: records that contain that frame alone. A pass that ran twice counts as their sum.
FrameTimes frame_times(const std::vector<PassRecord>& records);

}  // namespace lightgrid::app
