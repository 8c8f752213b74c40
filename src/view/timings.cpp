#include "view/timings.h"

#include <algorithm>

namespace lightgrid {

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

}  // namespace lightgrid
