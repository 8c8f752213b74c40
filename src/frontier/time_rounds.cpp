#include "frontier/time_rounds.h"

#include <fmt/format.h>

#include <algorithm>

#include "frontier/statistics.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

void add_time(const MeasuredPoint& point, size_t view, double ms, double beside,
              std::vector<TimeOfRecord>& times) {
  const FrontierRecord& record = point.records[view];
  if (record.refused.empty()) times.push_back({record_key(record), ms, beside, point.run.refused()});
}

bool is_refused(const FrontierRecord& record) { return !record.refused.empty(); }

// Of each round, over all views.
std::vector<double> ratios_of(const MeasuredPoint& point) {
  std::vector<double> ratios;
  for (size_t round = 0; round < size_t(point.rounds()); ++round) {
    double ms = 0, beside = 0;
    for (const FrontierRecord& record : point.records)
      ms += record.frame_ms[round], beside += record.baseline_ms[round];
    ratios.push_back(ms / beside);
  }
  return ratios;
}

}  // namespace

int TimeRounds::run() {
  int done = 0;
  for (const MeasuredPoint& point : points) done = std::max(done, point.rounds());
  double longest_s = 0;
  for (bool warm_up = true; done < job.most_rounds; warm_up = false) {
    const double before = timer.elapsed_ms() / 1000;
    if (done > 0 && before + longest_s > until_s) break;
    if (done >= job.least_rounds && are_certain()) break;
    std::vector<TimeOfRecord> times;
    for (size_t view = 0; view < views.size(); ++view) time_view(warm_up ? 0 : done + 1, view, times);
    if (warm_up) continue;
    file.add_times(times);
    for (MeasuredPoint& point : points) {
      for (FrontierRecord& record : point.records) record = file.open_records().at(record_key(record));
    }
    ++done;
    longest_s = std::max(longest_s, timer.elapsed_ms() / 1000 - before);
  }
  return done;
}

void TimeRounds::time_view(int round, size_t view, std::vector<TimeOfRecord>& times) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i) {
    const bool out = points[i].slow && (round == 0 || points[i].rounds() >= slow_rounds);
    if (!out && points[i].run.refused().empty()) order.push_back(i);
  }
  Random random(Random::mix(job.seed) + uint64_t(round) * 1000 + uint64_t(view));
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(random.next() % i)]);
  baseline.look(views[view]);
  baseline.draw();
  double beside = baseline.draw();
  for (size_t i = 0; i < order.size(); i += 2) {
    if (job.progress)
      job.progress(std::min(timer.elapsed_ms() / 1000 / job.seconds, 1.0),
                   fmt::format("times, round {}", round));
    MeasuredPoint& first = points[order[i]];
    add_time(first, view, timed(first, view), beside, times);
    if (i + 1 == order.size()) break;
    MeasuredPoint& second = points[order[i + 1]];
    const double ms = timed(second, view);
    beside = baseline.draw();
    add_time(second, view, ms, beside, times);
  }
}

double TimeRounds::timed(MeasuredPoint& point, size_t view) {
  point.run.look(views[view]);
  return point.run.draw();
}

// Whether each ratio's interval is narrow enough.
bool TimeRounds::are_certain() const {
  return std::ranges::all_of(points, [&](const MeasuredPoint& point) {
    if (std::ranges::any_of(point.records, is_refused)) return true;
    if (point.slow && point.rounds() >= slow_rounds) return true;
    const MedianInterval ratio = median_interval(ratios_of(point));
    return ratio.high - ratio.low <= job.interval_width * ratio.median;
  });
}

}  // namespace lightgrid
