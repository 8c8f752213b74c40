// Pass times of the last frames of one side.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "renderer/pass_timer.h"

namespace lightgrid {

struct PassMs {
  std::string name;
  double ms = 0;
};

struct FrameTimes {
  std::vector<PassMs> passes;  // in order of execution
  double total_ms() const;
};

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

}  // namespace lightgrid
