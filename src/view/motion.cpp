#include "view/motion.h"

#include <cmath>

#include <fmt/format.h>

namespace lightgrid {
namespace {

constexpr double seconds_a_step = 1.0 / 30;  // as along a camera path

const char* name_of(LightMotion motion) {
  return motion == LightMotion::orbit ? "orbit" : motion == LightMotion::drift ? "drift" : "none";
}

void add(std::vector<int>& to, const std::vector<int>& indices) {
  to.insert(to.end(), indices.begin(), indices.end());
}

}  // namespace

Motion::Motion(Scene& scene, LightMotion lights, std::optional<double> seconds)
    : scene_(scene),
      rig_(make_light_rig(scene, lights)),
      animated_(animation_count(scene) > 0),
      seconds_(seconds) {}

SceneChanges Motion::follow(Controls& controls, double seconds_passed) {
  const std::optional<double> before = seconds_;
  SceneChanges changes;
  if (controls.lights != rig_.motion) {
    changes = move_lights(scene_, rig_, 0);
    rig_ = make_light_rig(scene_, controls.lights);
  }
  if (controls.seconds) seconds_ = *controls.seconds;
  if (controls.step) {
    seconds_ = std::round((seconds() + seconds_a_step) * 1e6) / 1e6;
    controls.playing = false;
  } else if (controls.playing && can_play()) {
    seconds_ = std::round((seconds() + seconds_passed) * 1e6) / 1e6;
  }
  controls.seconds.reset();
  controls.step = false;
  if (seconds_ == before && changes.lights.empty() && rig_.motion == LightMotion::none) return changes;
  const SceneChanges posed = pose();
  add(changes.instances, posed.instances);
  add(changes.meshes, posed.meshes);
  add(changes.lights, posed.lights);
  add(changes.cameras, posed.cameras);
  return changes;
}

SceneChanges Motion::pose() {
  SceneChanges changes;
  if (animated_ && seconds_) changes = set_time(scene_, looped_time(scene_, *seconds_));
  add(changes.lights, move_lights(scene_, rig_, seconds()).lights);
  return changes;
}

std::string Motion::words() const {
  std::string words;
  const bool lights = rig_.motion != LightMotion::none;
  // Animations repeat; render stops at their end if no lights move.
  const double time = !lights && animated_ ? looped_time(scene_, seconds()) : seconds();
  if (seconds_ && (lights || animated_)) words += fmt::format(" --time {}", time);
  if (lights) words += fmt::format(" --light-motion {}", name_of(rig_.motion));
  return words;
}

}  // namespace lightgrid
