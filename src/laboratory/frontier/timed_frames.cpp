#include "frontier/timed_frames.h"

#include <utility>

#include "scene/random.h"

namespace lightgrid::lab {

void shuffle(std::vector<size_t>& order, uint64_t seed) {
  Random random(seed);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(random.next() % i)]);
}

// All frames have the same history, or their ratios would contain the difference: a look leaves uploads to the
// next frame, and other techniques' frames between push programs out of drivers' caches.
static RoundTimes timed(PointRun& run, const View& view, DeviceClock& clock) {
  run.look(view);
  run.draw_first_frame();
  const double ms = run.draw(&clock);
  return {ms, run.cpu_ms(), run.device_times()};
}

std::vector<std::vector<RoundTimes>> timed_frames(std::span<PointRun* const> runs, const View& view,
                                                  int passes, DeviceClock& clock,
                                                  const std::function<void()>& step) {
  std::vector<std::vector<RoundTimes>> times(size_t(passes), std::vector<RoundTimes>(runs.size()));
  for (size_t pass = 0; pass < times.size(); ++pass) {
    for (size_t i = 0; i < runs.size(); ++i) {
      const size_t place = pass % 2 == 0 ? i : runs.size() - 1 - i;
      times[pass][place] = timed(*runs[place], view, clock);
      step();
    }
  }
  return times;
}

}  // namespace lightgrid::lab
