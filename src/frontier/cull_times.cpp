#include "frontier/cull_times.h"

#include <algorithm>
#include <map>

#include "base/timer.h"
#include "frontier/answer_steps.h"

namespace lightgrid {
namespace {

constexpr size_t least_rounds = 6, most_rounds = 12;
constexpr double share_of_time = 0.1;  // of what is left

// Those that another one differs from in the cull test alone.
std::vector<PointOnView> with_partner(const std::vector<PointOnView>& points) {
  const auto group_of = [](const PointOnView& p) { return point_key(p.record.get().point, cull_test_alone); };
  std::map<std::string, int> sizes;
  std::vector<PointOnView> culled;
  for (const PointOnView& p : points) {
    const FrontierRecord& record = p.record;
    if (!record.refused.empty() || !record.pass_ms.contains(cull_pass) ||
        !record.point.settings.contains("cull_test"))
      continue;
    culled.push_back(p);
    ++sizes[group_of(p)];
  }
  std::erase_if(culled, [&](const PointOnView& p) { return sizes[group_of(p)] < 2; });
  return culled;
}

// Of one profiled frame.
double culling_ms(PointRun& point) {
  TechniqueRun& run = point.run();
  run.run_profiled_frames(0);
  double ms = 0;
  for (const PassRecord& pass : run.view().timer.records()) {
    if (pass.name == cull_pass && !pass.ms.empty()) ms += pass.ms.back();
  }
  return ms;
}

}  // namespace

void measure_cull_times(const std::vector<PointOnView>& points, const View& view, double seconds,
                        RecordFile& file) {
  std::vector<PointOnView> culled = with_partner(points);
  if (culled.empty()) return;
  const auto rounds_of = [](const PointOnView& p) { return p.record.get().cull_ms.size(); };
  // Without pass times it is not known what a frame takes.
  double round_s = 0;
  for (const PointOnView& p : culled) {
    for (const auto& [name, ms] : p.record.get().pass_ms) round_s += ms / 1000;
  }
  const Timer timer;
  const auto fits = [&](size_t rounds) {
    return timer.elapsed_ms() / 1000 + double(rounds) * round_s <= share_of_time * seconds;
  };
  const size_t begun = std::ranges::min(culled, {}, rounds_of).record.get().cull_ms.size();
  if (begun == 0 && !fits(least_rounds)) return;
  for (const PointOnView& p : culled) p.run.get().look(view);
  for (size_t round = begun; round < most_rounds; ++round) {
    if (round >= least_rounds && !fits(1)) break;
    std::map<std::string, double> times;
    std::ranges::reverse(culled);
    for (const PointOnView& p : culled) {
      const double ms = culling_ms(p.run);
      times[record_key(p.record)] = ms;
      p.record.get().cull_ms.push_back(ms);
    }
    file.add_cull_times(times);
  }
}

}  // namespace lightgrid
