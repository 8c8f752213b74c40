#include "view/clock.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace lightgrid::app {

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
  const bool other_rig = controls.lights != rig_.motion;
  if (other_rig) {
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
  if (seconds_ == before && !other_rig) return changes;
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

double Resolution::next(bool moving, double seconds, double rate) {
  since_move_s_ = moving ? 0 : since_move_s_ + seconds;
  drawn_ = 1;
  if (resting() || rate <= 0) return drawn_;
  if (full_ms_ == 0) return drawn_ = fraction_;
  constexpr std::array fractions = {1.0, 0.75, 0.5, 0.375, 0.25};
  const double budget_ms = std::max(1000 / rate - window_ms_, 250 / rate);
  for (const double fraction : fractions) {
    drawn_ = fraction;
    if (full_ms_ * fraction * fraction <= budget_ms) break;
  }
  // Grows only with room to spare; otherwise the size would change in every frame.
  if (drawn_ > fraction_ && full_ms_ * drawn_ * drawn_ > 0.8 * budget_ms) drawn_ = fraction_;
  fraction_ = drawn_;
  return drawn_;
}

void Resolution::measured(double frame_ms, double window_ms) {
  const double full = frame_ms / (drawn_ * drawn_);
  window_ms_ = window_ms_ == 0 ? window_ms : 0.7 * window_ms_ + 0.3 * window_ms;
  full_ms_ = full_ms_ == 0 ? full : 0.7 * full_ms_ + 0.3 * full;
}

double FrameTimes::total_ms() const {
  double total = 0;
  for (const PassMs& pass : passes) total += pass.ms;
  return total;
}

void Timings::add(FrameTimes frame) {
  frames_.push_back(std::move(frame));
  if (frames_.size() > kept_frames) frames_.pop_front();
}

FrameTimes Timings::mean(size_t count) const {
  FrameTimes mean;
  if (frames_.empty()) return mean;
  const size_t first = frames_.size() - std::min(count, frames_.size());
  for (const PassMs& last : frames_.back().passes) {
    double sum = 0;
    for (size_t i = first; i < frames_.size(); ++i) {
      for (const PassMs& pass : frames_[i].passes) sum += pass.name == last.name ? pass.ms : 0;
    }
    mean.passes.push_back({last.name, sum / double(frames_.size() - first)});
  }
  return mean;
}

FrameTimes frame_times(const std::vector<PassRecord>& records) {
  FrameTimes frame;
  for (const PassRecord& record : records) {
    double ms = 0;
    for (const double one : record.ms) ms += one;
    if (!record.ms.empty()) frame.passes.push_back({record.name, ms});
  }
  return frame;
}

}  // namespace lightgrid::app
