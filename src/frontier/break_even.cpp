// What a tighter cull test must save, and what it saves: docs/frontier.md#break-even.
#include <algorithm>
#include <limits>
#include <set>

#include "frontier/answer_steps.h"

namespace lightgrid {
namespace {

constexpr double ns_per_ms = 1e6;
constexpr const char* cull_pass = "cull_lights";
constexpr const char* shading_passes[] = {"shade_forward", "shade_tiles", "resolve", "shade_objects",
                                          "shade_light_volumes", "fill_light_buffer"};
const std::vector<std::string> cull_test_alone = {"cull_test"};
const std::vector<std::string> bounds_and_test = {"cull_test", "depth_bounds"};

bool has_cull_time(const FrontierRecord& r) {
  return r.series.empty() && r.refused.empty() && r.pass_ms.contains(cull_pass) &&
         r.point.settings.contains("cull_test");
}

// Passes are profiled on the first view of a point; pairs are taken from the same one.
std::vector<const FrontierRecord*> profiled(Records records) {
  std::vector<const FrontierRecord*> first;
  std::set<std::string> keys;
  for (const FrontierRecord& r : records) {
    if (has_cull_time(r) && keys.insert(point_key(r.point)).second) first.push_back(&r);
  }
  return first;
}

BreakEven break_even_of(const FrontierRecord& a, const FrontierRecord& b) {
  const double ms_a = a.pass_ms.at(cull_pass), ms_b = b.pass_ms.at(cull_pass);
  const double listed_a = double(a.pairs.listed), listed_b = double(b.pairs.listed);
  // With equal lists, the slower test counts as the tighter one, which then never wins.
  const bool a_is_tighter = listed_a != listed_b ? listed_a < listed_b : ms_a > ms_b;
  const FrontierRecord& tighter = a_is_tighter ? a : b;
  const FrontierRecord& looser = a_is_tighter ? b : a;
  BreakEven found{a.point.scene, tighter.point.label, looser.point.label};
  found.extra_ms = tighter.pass_ms.at(cull_pass) - looser.pass_ms.at(cull_pass);
  found.pairs_saved = double(looser.pairs.listed) - double(tighter.pairs.listed);
  if (found.extra_ms <= 0) {
    found.ns_per_pixel_light = 0;
  } else if (found.pairs_saved == 0) {
    found.ns_per_pixel_light = std::numeric_limits<double>::infinity();
  } else {
    found.ns_per_pixel_light = found.extra_ms * ns_per_ms / found.pairs_saved;
  }
  return found;
}

struct PairsAndMs {
  double pairs = 0, ms = 0;
};

// Sums of products of deviations from the samples' means.
void add_deviations(const std::vector<PairsAndMs>& samples, double& pairs_squared, double& pairs_ms) {
  PairsAndMs mean;
  for (const PairsAndMs& s : samples)
    mean.pairs += s.pairs / double(samples.size()), mean.ms += s.ms / double(samples.size());
  for (const PairsAndMs& s : samples) {
    pairs_squared += (s.pairs - mean.pairs) * (s.pairs - mean.pairs);
    pairs_ms += (s.pairs - mean.pairs) * (s.ms - mean.ms);
  }
}

}  // namespace

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
    double pairs_squared = 0, pairs_ms = 0;
    for (const auto& [group, samples] : groups[i]) add_deviations(samples, pairs_squared, pairs_ms);
    if (pairs_squared == 0 || !(pairs_ms > 0)) continue;  // nothing varied, or noise outweighs the lists
    costs[i].ns_per_pixel_light = ns_per_ms * pairs_ms / pairs_squared;
    measured.push_back(costs[i]);
  }
  return measured;
}

}  // namespace lightgrid
