// One contestant's times relative to another's, frame by frame (measures/ratio_of_times.h).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "run/frame_figures.h"

namespace lightgrid::lab {

// Wall-clock and processor times of the same frames. Entry i of two contestants is of one pass over all.
struct FrameTimes {
  std::span<const double> wall_ms, cpu_ms;
};
inline FrameTimes times_of(const FrameFigures& row) { return {row.wall_ms, row.cpu_ms}; }

struct RelativeFrames {
  double estimate = 0;
  double low = 0, high = 0;  // 95 % interval, if has_interval()
  int frames = 0;            // of both
  bool by_cpu = false;       // processor time instead of wall-clock time

  static constexpr int min_frames = 3;
  static constexpr double wanted_half_width = 0.01;
  bool has_interval() const { return frames >= min_frames; }
  double half_width() const;  // as a share; infinite without an interval
  bool reached() const { return half_width() <= wanted_half_width; }
  bool is_faster() const { return has_interval() && high < 1; }  // surely
  bool is_slower() const { return has_interval() && low > 1; }
  // "0.93 of its time (95 % interval 0.92 to 0.94; processor time)".
  std::string in_words() const;
};

RelativeFrames relative_wall_time(const FrameTimes& times, const FrameTimes& others);
RelativeFrames relative_cpu_time(const FrameTimes& times, const FrameTimes& others);
// Wall-clock time or, if its interval did not reach the wanted half-width and that of processor time is
// narrower, processor time. No frames: one of the two was not timed.
RelativeFrames relative_frames(const FrameTimes& times, const FrameTimes& others);

// {"estimate", "ci95", "frames", "half_width", "reached"}; null without frames.
nlohmann::ordered_json to_json(const RelativeFrames& relative);

}  // namespace lightgrid::lab
