#include "frontier/round_baselines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightgrid::lab {
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
  for (const FrontierRecord& record : records) {
    if (!record.series.empty() && !is_control(record)) continue;
    const std::vector<TimeBlock> blocks = blocks_of(record);
    for (size_t run = 0; run < blocks.size(); ++run)
      runs_[{record.point.scene, record.view, blocks[run]}].push_back(record.baseline_ms[run]);
  }
}

double RoundBaselines::ms_of(const Place& place, size_t series) const {
  const std::vector<double>& of_round = runs_.at(place);
  const TimeBlock& block = std::get<TimeBlock>(place);
  return of_round[(size_t(block.round + block.process) * baseline_runs + series) % of_round.size()];
}

LogTimes RoundBaselines::log_times(const Group& views) const {
  struct Sums {
    double ms = 0;
    std::array<double, baseline_runs> baseline_ms = {};
    size_t views = 0;
  };
  std::map<TimeBlock, Sums> sums;
  for (const FrontierRecord* view : views) {
    const std::vector<TimeBlock> blocks = blocks_of(*view);
    for (size_t run = 0; run < blocks.size(); ++run) {
      Sums& of = sums[blocks[run]];
      of.ms += view->frame_ms[run];
      for (size_t k = 0; k < baseline_runs; ++k)
        of.baseline_ms[k] += ms_of({view->point.scene, view->view, blocks[run]}, k);
      ++of.views;
    }
  }
  LogTimes times;
  for (const auto& [block, of] : sums) {
    if (of.views != views.size()) continue;
    LogRatios ratios;
    for (const double baseline_ms : of.baseline_ms) ratios.push_back(std::log(of.ms / baseline_ms));
    if (std::ranges::all_of(ratios, [](double ratio) { return std::isfinite(ratio); })) times[block] = ratios;
  }
  return times;
}

}  // namespace lightgrid::lab
