// What a tighter cull test must save, and what it saves (docs/frontier.md#break-even); and how frame time
// grows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/timer.h"
#include "frontier/answer_steps.h"

namespace lightgrid {
namespace {

constexpr double ns_per_ms = 1e6;
constexpr const char* shading_passes[] = {"shade_forward", "shade_tiles",         "resolve",
                                          "shade_objects", "shade_light_volumes", "fill_light_buffer"};
const std::vector<std::string> bounds_and_test = {"cull_test", "depth_bounds"};

// Passes are profiled on the first view of a point; pairs are taken from the same one.
std::vector<const FrontierRecord*> profiled(Records records) {
  std::vector<const FrontierRecord*> first;
  std::set<std::string> keys;
  for (const FrontierRecord& r : records) {
    if (has_cull_time(r) && keys.insert(point_key(r.point)).second) first.push_back(&r);
  }
  return first;
}

// Of culling, `a` over `b`: the differences of the rounds in which one process measured both; otherwise that
// of the medians.
MedianInterval extra_ms_of(const FrontierRecord& a, const FrontierRecord& b) {
  std::vector<double> differences;
  const size_t rounds = a.shard == b.shard ? std::min(a.cull_ms.size(), b.cull_ms.size()) : 0;
  for (size_t round = 0; round < rounds; ++round) differences.push_back(a.cull_ms[round] - b.cull_ms[round]);
  if (!differences.empty()) return median_interval(differences);
  return {.median = a.pass_ms.at(cull_pass) - b.pass_ms.at(cull_pass)};
}

BreakEven break_even_of(const FrontierRecord& a, const FrontierRecord& b) {
  const double listed_a = double(a.pairs.listed), listed_b = double(b.pairs.listed);
  // With equal lists, the slower test counts as the tighter one, which then never wins.
  const bool a_is_tighter = listed_a != listed_b ? listed_a < listed_b : extra_ms_of(a, b).median > 0;
  const FrontierRecord& tighter = a_is_tighter ? a : b;
  const FrontierRecord& looser = a_is_tighter ? b : a;
  const MedianInterval extra_ms = extra_ms_of(tighter, looser);
  BreakEven found{a.point.scene, tighter.point.label, looser.point.label};
  found.extra_ms = extra_ms.median;
  found.pairs_saved = double(looser.pairs.listed) - double(tighter.pairs.listed);
  if (found.pairs_saved == 0) {
    found.ns_per_pixel_light = found.extra_ms <= 0 ? 0 : std::numeric_limits<double>::infinity();
    return found;
  }
  const auto ns_of = [&](double ms) { return std::max(ms, 0.0) * ns_per_ms / found.pairs_saved; };
  found.ns_per_pixel_light = ns_of(extra_ms.median);
  found.low = ns_of(extra_ms.low), found.high = ns_of(extra_ms.high);
  found.rounds = extra_ms.runs;
  return found;
}

struct PairsAndMs {
  double pairs = 0, ms = 0;
};

// Sums of products of deviations from the means of each group of samples.
struct Deviations {
  double pairs_squared = 0, pairs_ms = 0, ms_squared = 0;
  int degrees_of_freedom = -1;  // of the residuals: samples less groups less one, the slope

  void add(const std::vector<PairsAndMs>& samples) {
    PairsAndMs mean;
    for (const PairsAndMs& s : samples)
      mean.pairs += s.pairs / double(samples.size()), mean.ms += s.ms / double(samples.size());
    for (const PairsAndMs& s : samples) {
      pairs_squared += (s.pairs - mean.pairs) * (s.pairs - mean.pairs);
      pairs_ms += (s.pairs - mean.pairs) * (s.ms - mean.ms);
      ms_squared += (s.ms - mean.ms) * (s.ms - mean.ms);
    }
    degrees_of_freedom += int(samples.size()) - 1;
  }
};

double place_in_series(const FrontierRecord& r) {
  if (r.series == "lights") return r.lights;
  if (r.series == "pixels") return double(r.width) * r.height;
  return r.radius_scale;
}

}  // namespace

bool has_cull_time(const FrontierRecord& r) {
  return r.series.empty() && r.refused.empty() && r.pass_ms.contains(cull_pass) &&
         r.point.settings.contains("cull_test");
}

std::vector<BreakEven> break_evens_of(Records records) {
  std::vector<std::string> keys;
  std::map<std::string, std::vector<const FrontierRecord*>> groups;  // that differ in the cull test alone
  for (const FrontierRecord* r : profiled(records)) {
    const std::string key = point_key(r->point, cull_test_alone) + "\n" + std::to_string(r->view);
    if (!groups.contains(key)) keys.push_back(key);
    groups[key].push_back(r);
  }
  std::vector<BreakEven> all;
  for (const std::string& key : keys) {
    const auto& group = groups[key];
    for (size_t a = 0; a < group.size(); ++a) {
      for (size_t b = a + 1; b < group.size(); ++b) all.push_back(break_even_of(*group[a], *group[b]));
    }
  }
  return all;
}

// One slope through groups of samples that each have an intercept of their own: all that differs between the
// samples of a group is the cull test and the depth bounds.
std::vector<ShadingCost> shading_costs_of(Records records) {
  std::vector<ShadingCost> costs;
  std::vector<std::map<std::string, std::vector<PairsAndMs>>> groups;  // of each cost
  for (const FrontierRecord* record : profiled(records)) {
    const FrontierRecord& r = *record;
    double ms = 0;
    bool shades = false;
    for (const char* pass : shading_passes) {
      const auto found = r.pass_ms.find(pass);
      if (found == r.pass_ms.end()) continue;
      ms += found->second;
      shades = true;
    }
    if (!shades) continue;
    const auto brdf = r.point.settings.find("brdf");
    const ShadingCost cost{r.point.scene, r.point.technique,
                           brdf == r.point.settings.end() ? "" : brdf->second};
    size_t index = 0;
    while (index < costs.size() &&
           (costs[index].scene != cost.scene || costs[index].technique != cost.technique ||
            costs[index].brdf != cost.brdf)) {
      ++index;
    }
    if (index == costs.size()) costs.push_back(cost), groups.emplace_back();
    const std::string group = point_key(r.point, bounds_and_test) + "\n" + std::to_string(r.view);
    groups[index][group].push_back({double(r.pairs.listed), ms});
  }
  std::vector<ShadingCost> measured;
  for (size_t i = 0; i < costs.size(); ++i) {
    Deviations of;
    for (const auto& [group, samples] : groups[i]) of.add(samples);
    if (of.pairs_squared == 0 || !(of.pairs_ms > 0))
      continue;  // nothing varied, or noise outweighs the lists
    const double slope = of.pairs_ms / of.pairs_squared;
    const double residuals = std::max(of.ms_squared - slope * of.pairs_ms, 0.0);
    const double half = of.degrees_of_freedom < 1
                            ? std::numeric_limits<double>::infinity()
                            : student_t_quantile(0.975, of.degrees_of_freedom) *
                                  std::sqrt(residuals / of.degrees_of_freedom / of.pairs_squared);
    costs[i].ns_per_pixel_light = ns_per_ms * slope;
    costs[i].low = ns_per_ms * (slope - half), costs[i].high = ns_per_ms * (slope + half);
    measured.push_back(costs[i]);
  }
  return measured;
}

std::vector<Growth> growth_of(Records records) {
  std::vector<Growth> curves;
  std::vector<std::map<double, std::vector<double>>> medians;  // of each curve: by x, one a view
  for (const FrontierRecord& r : records) {
    if (r.series.empty() || !r.refused.empty() || r.frame_ms.empty()) continue;
    const auto same = [&](const Growth& g) {
      return g.scene == r.point.scene && g.technique == r.point.label && g.of == r.series;
    };
    size_t index = size_t(std::find_if(curves.begin(), curves.end(), same) - curves.begin());
    if (index == curves.size())
      curves.push_back({r.point.scene, r.point.label, r.series}), medians.emplace_back();
    medians[index][place_in_series(r)].push_back(spread_of(r.frame_ms).median);
  }
  for (size_t i = 0; i < curves.size(); ++i) {
    for (const auto& [x, of_views] : medians[i]) {
      double sum = 0;
      for (const double ms : of_views) sum += ms;
      curves[i].samples.emplace_back(x, sum / double(of_views.size()));
    }
    const PowerLaw law = power_law(curves[i].samples);
    curves[i].exponent = law.exponent, curves[i].low = law.low, curves[i].high = law.high;
  }
  std::erase_if(curves, [](const Growth& g) { return g.samples.size() < 2; });
  return curves;
}

}  // namespace lightgrid
