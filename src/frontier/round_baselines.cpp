#include "frontier/round_baselines.h"

#include <cmath>
#include <set>

#include "base/timer.h"

namespace lightgrid {
namespace {

// The round of each run: its number among those of its process.
std::vector<TimeBlock> blocks_of(const FrontierRecord& record) {
  std::vector<TimeBlock> blocks;
  std::map<int, int> rounds;
  for (size_t run = 0; run < record.frame_ms.size(); ++run) {
    const int process = run < record.processes.size() ? record.processes[run] : 0;
    blocks.push_back({record.shard, process, rounds[process]++});
  }
  return blocks;
}

}  // namespace

RoundBaselines::RoundBaselines(Records records) {
  std::map<Place, std::set<double>> runs;  // two points may share one
  for (const FrontierRecord& record : records) {
    if (!record.series.empty() && !is_control(record)) continue;
    const std::vector<TimeBlock> blocks = blocks_of(record);
    for (size_t run = 0; run < blocks.size(); ++run)
      runs[{record.point.scene, record.view, blocks[run]}].insert(record.baseline_ms[run]);
  }
  for (const auto& [place, times] : runs) medians_[place] = spread_of({times.begin(), times.end()}).median;
}

LogTimes RoundBaselines::log_times(const Group& views) const {
  struct Sums {
    double ms = 0, baseline_ms = 0;
    size_t views = 0;
  };
  std::map<TimeBlock, Sums> sums;
  for (const FrontierRecord* view : views) {
    const std::vector<TimeBlock> blocks = blocks_of(*view);
    for (size_t run = 0; run < blocks.size(); ++run) {
      Sums& of = sums[blocks[run]];
      of.ms += view->frame_ms[run];
      of.baseline_ms += medians_.at({view->point.scene, view->view, blocks[run]});
      ++of.views;
    }
  }
  LogTimes times;
  for (const auto& [block, of] : sums) {
    const double ratio = of.ms / of.baseline_ms;
    if (of.views == views.size() && ratio > 0 && std::isfinite(ratio)) times[block] = std::log(ratio);
  }
  return times;
}

}  // namespace lightgrid
