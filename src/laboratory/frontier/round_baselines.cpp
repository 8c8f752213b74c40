#include "frontier/round_baselines.h"

#include <cmath>

#include "base/timer.h"

namespace lightgrid::lab {
namespace {

struct Round {
  double ms = 0, baseline_ms = 0;
  int frames = 0;
};

// The complete rounds of a record, by their numbers among those of their process.
std::map<TimeBlock, Round> rounds_of(const FrontierRecord& record) {
  std::map<TimeBlock, Round> rounds;
  std::map<int, int> frames;
  for (size_t run = 0; run < record.frame_ms.size(); ++run) {
    const int process = run < record.processes.size() ? record.processes[run] : 0;
    Round& round = rounds[{record.shard, process, frames[process]++ / record.frames_per_round}];
    round.ms += record.frame_ms[run];
    round.baseline_ms += record.baseline_ms[run];
    ++round.frames;
  }
  std::erase_if(rounds, [&](const auto& entry) { return entry.second.frames < record.frames_per_round; });
  return rounds;
}

}  // namespace

RoundBaselines::RoundBaselines(Records records) {
  for (const FrontierRecord& record : records) {
    if (!record.series.empty() && !is_control(record)) continue;
    for (const auto& [block, round] : rounds_of(record))
      rounds_[{record.point.scene, record.view, block}].push_back(round.baseline_ms);
  }
}

double RoundBaselines::ms_of(const Place& place, size_t number) const {
  const std::vector<double>& of_round = rounds_.at(place);
  const TimeBlock& block = std::get<TimeBlock>(place);
  constexpr size_t step = 3;  // from round to round
  return of_round[(size_t(block.round + block.process) * step + number) % of_round.size()];
}

PointTimes RoundBaselines::times_of(const Group& views, size_t place) const {
  struct Sums {
    double ms = 0, baseline_ms = 0;
    size_t views = 0;
  };
  PointTimes times;
  std::map<TimeBlock, Sums> sums;
  for (const FrontierRecord* view : views) {
    ViewTimes& of_view = times.views[view->view];
    std::vector<double> baselines;
    for (const auto& [block, round] : rounds_of(*view)) {
      const double baseline_ms = ms_of({view->point.scene, view->view, block}, place);
      const double ratio = std::log(round.ms / baseline_ms);
      if (std::isfinite(ratio)) of_view.rounds[block] = ratio;
      baselines.push_back(baseline_ms);
      Sums& sum = sums[block];
      sum.ms += round.ms;
      sum.baseline_ms += baseline_ms;
      ++sum.views;
    }
    of_view.baseline_ms = spread_of(baselines).median;
    if (of_view.rounds.empty()) times.views.erase(view->view);
  }
  for (const auto& [block, sum] : sums) {
    const double ratio = std::log(sum.ms / sum.baseline_ms);
    if (sum.views == views.size() && std::isfinite(ratio)) times.rounds[block] = ratio;
  }
  return times;
}

}  // namespace lightgrid::lab
