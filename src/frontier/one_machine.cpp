#include "frontier/one_machine.h"

#include <map>
#include <tuple>

#include "frontier/statistics.h"

namespace lightgrid {
namespace {

auto kind_of(const FrontierMachine& m) {
  return std::tie(m.cl_device, m.gl_device, m.cl_driver, m.gl_driver, m.cpu, m.threads);
}

// The number of each shard's kind of machine; shards that nobody describes are of kind 0.
std::map<int, int> kinds_of(const std::vector<FrontierMachine>& machines) {
  std::vector<const FrontierMachine*> kinds;
  std::map<int, int> of_shard;
  for (const FrontierMachine& machine : machines) {
    size_t kind = 0;
    while (kind < kinds.size() && kind_of(*kinds[kind]) != kind_of(machine)) ++kind;
    if (kind == kinds.size()) kinds.push_back(&machine);
    of_shard.emplace(machine.shard, static_cast<int>(kind));
  }
  return of_shard;
}

using BaselineTimes = std::map<int, std::vector<double>>;  // by view

// 0 if no view is in both.
double times_longer(const BaselineTimes& first, const BaselineTimes& other) {
  double of_first = 0, of_other = 0;
  for (const auto& [view, times] : first) {
    const auto same = other.find(view);
    if (same == other.end()) continue;
    of_first += median_interval(times).median;
    of_other += median_interval(same->second).median;
  }
  return of_other > 0 ? of_first / of_other : 0;
}

}  // namespace

std::vector<FrontierRecord> on_one_machine(std::vector<FrontierRecord> records,
                                           const std::vector<FrontierMachine>& machines) {
  const std::map<int, int> kinds = kinds_of(machines);
  const auto kind_of_record = [&](const FrontierRecord& r) {
    const auto found = kinds.find(r.shard);
    return found == kinds.end() ? 0 : found->second;
  };
  std::map<std::string, std::map<int, BaselineTimes>> baselines;  // by scene and kind
  for (const FrontierRecord& r : records) {
    if (!r.series.empty()) continue;  // of other sizes and lights
    std::vector<double>& times = baselines[r.point.scene][kind_of_record(r)][r.view];
    times.insert(times.end(), r.baseline_ms.begin(), r.baseline_ms.end());
  }
  for (FrontierRecord& r : records) {
    const auto& of_scene = baselines[r.point.scene];
    const int kind = kind_of_record(r);
    if (of_scene.empty() || of_scene.begin()->first == kind) continue;
    const auto own = of_scene.find(kind);
    const double factor = own == of_scene.end() ? 0 : times_longer(of_scene.begin()->second, own->second);
    if (factor == 0) {
      r.pass_ms.clear();
      r.cull_ms.clear();
      continue;
    }
    for (double& ms : r.frame_ms) ms *= factor;
    for (double& ms : r.baseline_ms) ms *= factor;
    for (auto& [pass, ms] : r.pass_ms) ms *= factor;
    for (double& ms : r.cull_ms) ms *= factor;
  }
  return records;
}

}  // namespace lightgrid
