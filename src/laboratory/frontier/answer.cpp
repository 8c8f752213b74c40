// Records of all parts become one answer.
#include "frontier/answer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "frontier/answer_steps.h"
#include "frontier/record_file.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

// Records of all parts; of those with one key, the first.
std::vector<FrontierRecord> joined(const std::vector<FrontierPart>& parts) {
  std::vector<FrontierRecord> records;
  std::set<std::string> keys;
  for (const FrontierPart& part : parts) {
    for (const FrontierRecord& record : part.records) {
      if (keys.insert(record_key(record)).second) records.push_back(record);
    }
  }
  return records;
}

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

bool errors_are_finite(const FrontierRecord& record) {
  const PointErrors& errors = record.errors;
  if (!std::isfinite(errors.total.max_rel) || !std::isfinite(errors.total.rmse_rel)) return false;
  return record.external ||
         (std::isfinite(errors.technique.max_rel) && std::isfinite(errors.technique.rmse_rel));
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
    if (!r.series.empty()) continue;  // other sizes and lights
    if (is_unpaired(r)) continue;     // another session
    std::vector<double>& times = baselines[r.point.scene][kind_of_record(r)][r.view];
    times.insert(times.end(), r.baseline_ms.begin(), r.baseline_ms.end());
  }
  for (FrontierRecord& r : records) {
    if (is_unpaired(r)) continue;
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

std::string label_in_series(const FrontierRecord& r) {
  if (r.series == "lights")
    return fmt::format("{}, {} lights", r.point.label, with_commas(uint64_t(r.lights)));
  if (r.series == "pixels") return fmt::format("{}, {} × {}", r.point.label, r.width, r.height);
  if (r.series == "radius") return fmt::format("{}, radius × {:g}", r.point.label, r.radius_scale);
  if (is_of_family(r)) {
    return fmt::format("{}, {} lights, {} at a pixel", r.point.label, with_commas(uint64_t(r.lights)),
                       three_digits(r.overlap.value_or(0)));
  }
  return r.point.label;
}

std::vector<Failure> failures_of(Records records) {
  std::vector<Failure> failures;
  for (const Group& views :
       grouped(accepted(records, [](const FrontierRecord&) { return true; }),
               [](const FrontierRecord& r) { return point_key(r.point) + label_in_series(r); })) {
    FrontierPoint point = views.back()->point;
    point.label = label_in_series(*views.back());
    const auto add = [&](const char* cause, const std::string& why) {
      failures.push_back({point, cause, why});
    };
    std::string refused;
    uint64_t lost = 0, wrong = 0, nan_pixels = 0, overflow = 0, shadows = 0;
    bool finite = true;
    for (const FrontierRecord* r : views) {
      if (refused.empty()) refused = r->refused;
      if (!r->refused.empty()) continue;
      lost += r->pairs.lost;
      wrong += r->pairs.wrong;
      if (r->pairs.shadows) shadows += r->pairs.shadows->faults();
      nan_pixels += r->nan_pixels;
      overflow += r->overflow;
      finite &= is_of_family(*r) ? r->errors.authored && std::isfinite(r->errors.authored->total.rmse_rel)
                                 : errors_are_finite(*r);
    }
    if (!refused.empty()) add("refused", "refused: " + refused);
    if (lost) add("lost", with_commas(lost) + " lit pairs are not listed");
    if (wrong) add("wrong", with_commas(wrong) + " listed pairs are no light, or twice the same");
    if (shadows) add("shadow", with_commas(shadows) + " pairs have a wrong shadow that is said to be exact");
    if (nan_pixels) {
      add("NaN", with_commas(nan_pixels) + " pixels are NaN");
    } else if (!finite) {
      add("NaN", "its error is not finite");
    }
    if (overflow) add("overflow", with_commas(overflow) + " list entries did not fit");
  }
  return failures;
}

std::vector<ProcessConditions> process_conditions_of(const std::vector<FrontierPart>& parts) {
  const auto raise = [](std::optional<double>& most, const std::optional<double>& value) {
    if (value) most = std::max(most.value_or(*value), *value);
  };
  const auto widen = [](std::optional<std::pair<double, double>>& range, const std::optional<double>& value) {
    if (!value) return;
    if (!range) range.emplace(*value, *value);
    range = {std::min(range->first, *value), std::max(range->second, *value)};
  };
  std::map<std::pair<int, int>, ProcessConditions> processes;
  for (const FrontierPart& part : parts) {
    for (const FrontierConditions& c : part.conditions) {
      ProcessConditions& p = processes[{part.shard, c.process}];
      p.shard = part.shard;
      p.process = c.process;
      ++p.rounds;
      raise(p.others_percent, c.others_percent);
      raise(p.steal_percent, c.steal_percent);
      raise(p.temperature_c, c.temperature_c);
      widen(p.clock_mhz, c.clock_mhz);
      widen(p.power_w, c.power_w);
      p.shared_rounds += is_shared(c);
      p.throttled_rounds += is_throttled(c);
    }
  }
  std::vector<ProcessConditions> all;
  for (const auto& [key, process] : processes) all.push_back(process);
  return all;
}

std::vector<Coverage> coverage_of(const std::vector<FrontierPart>& parts,
                                  const std::vector<PointFigures>& points) {
  std::vector<Coverage> all;
  for (const FrontierPart& part : parts) {
    for (const auto& [scene, count] : part.points_asked) {
      auto of_scene = std::ranges::find(all, scene, &Coverage::scene);
      if (of_scene == all.end()) of_scene = all.insert(all.end(), Coverage{scene});
      of_scene->asked += count;
    }
  }
  for (Coverage& c : all)
    c.measured =
        int(std::ranges::count_if(points, [&](const PointFigures& p) { return p.point.scene == c.scene; }));
  return all;
}

FrontierAnswer answer_of(const std::vector<FrontierPart>& parts) {
  if (parts.empty()) throw input_error("frontier: no part to answer from");
  const auto name_of = [](const FrontierPart& part) {
    return fmt::format("shard {}/{}", part.shard, part.shards);
  };
  for (const FrontierPart& part : parts)
    check_same_sweep(name_of(part), part, parts.front(), name_of(parts.front()));
  FrontierAnswer answer;
  answer.part = parts.front();
  answer.part.records = joined(parts);
  for (const FrontierPart& part : parts) answer.machines.push_back(part.machine);
  answer.processes = process_conditions_of(parts);
  const std::vector<FrontierRecord> records = on_one_machine(answer.part.records, answer.machines);
  answer.points = figures_of(records);
  answer.coverage = coverage_of(parts, answer.points);
  for (const FrontierPart& part : parts) add_distinct(answer.part.warnings, part.warnings);
  answer.controls = controls_of(records);
  set_relative_times(answer.points, answer.controls);
  rank_points(answer.points, answer.controls);
  answer.cheapest_within = cheapest_within_of(answer.points, answer.controls);
  answer.front_bands = front_bands_of(answer.points, answer.controls);
  set_device_figures(answer);
  set_cpu_figures(answer);
  answer.among_opencl = among_opencl_of(answer);
  answer.break_even = break_evens_of(records);
  answer.shading_costs = shading_costs_of(records);
  answer.growth = growth_of(records, answer.part.keep);
  answer.equal_flip = equal_flip_of(records);
  answer.failures = failures_of(records);
  answer.sentences = sentences_of(answer);
  return answer;
}

}  // namespace lightgrid::lab
