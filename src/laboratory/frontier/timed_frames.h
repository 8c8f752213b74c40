// Frames of several points on one view, timed in one order and in the reverse one. All times of sweeps and of
// races are taken here.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "frontier/points.h"

namespace lightgrid::lab {

constexpr int frames_per_round = 2;  // of each point: in random order, and back

struct RoundTimes {
  double ms = 0;
  std::optional<double> cpu_ms;       // processor time of this process in the same frame
  std::optional<DeviceTimes> device;  // times of the same frame
};

void shuffle(std::vector<size_t>& order, uint64_t seed);

// One pass draws a frame of each of `runs`, in their order; the next one in the reverse order: what drifts
// during both cancels in their sums. Before each timed frame, the same point looks at the view and draws a frame
// that does not count. `step` is called after each timed frame. Returns, for each pass, times in the order of
// `runs`.
std::vector<std::vector<RoundTimes>> timed_frames(std::span<PointRun* const> runs, const View& view,
                                                  int passes, DeviceClock& clock,
                                                  const std::function<void()>& step);

}  // namespace lightgrid::lab
