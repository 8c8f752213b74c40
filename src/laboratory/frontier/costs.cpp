// The saving that a tighter cull test needs, and its actual saving (docs/frontier.md#break-even); and the
// growth of frame times.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/timer.h"
#include "frontier/answer_steps.h"
#include "frontier/fields.h"

namespace lightgrid::lab {
namespace {

constexpr double ns_per_ms = 1e6;
constexpr const char* shading_passes[] = {"shade_forward", "shade_tiles",         "resolve",
                                          "shade_objects", "shade_light_volumes", "fill_light_buffer"};
const std::vector<std::string> bounds_and_test = {"cull_test", "depth_bounds"};

// Passes are profiled on the first view of a point; pairs are taken from the same one.
Group profiled(Records records) {
  Group first;
  for (const Group& views :
       grouped(accepted(records, has_cull_time), [](const FrontierRecord& r) { return point_key(r.point); }))
    first.push_back(views.front());
  return first;
}

std::string key_on_view(const FrontierRecord& r, const std::vector<std::string>& without) {
  return point_key(r.point, without) + "\n" + std::to_string(r.view);
}

// The time of all passes that shade; none if there is no such pass.
std::optional<double> shading_ms(const FrontierRecord& r) {
  std::optional<double> ms;
  for (const char* pass : shading_passes) {
    const auto found = r.pass_ms.find(pass);
    if (found != r.pass_ms.end()) ms = ms.value_or(0) + found->second;
  }
  return ms;
}

std::string brdf_of(const FrontierRecord& r) {
  const auto brdf = r.point.settings.find("brdf");
  return brdf == r.point.settings.end() ? "" : brdf->second;
}

// How much longer `a` culls than `b`: the differences of the rounds in which one process measured both;
// otherwise the difference of the medians.
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
  found.low = ns_of(extra_ms.low);
  found.high = ns_of(extra_ms.high);
  found.rounds = extra_ms.runs;
  return found;
}

struct PairsAndMs {
  double pairs = 0, ms = 0;
};

// Sums of products of deviations from the means of each group of samples.
struct Deviations {
  double pairs_squared = 0, pairs_ms = 0, ms_squared = 0;
  int degrees_of_freedom = -1;  // for the residuals: samples less groups less one, the slope

  void add(const std::vector<PairsAndMs>& samples) {
    PairsAndMs mean;
    for (const PairsAndMs& s : samples) {
      mean.pairs += s.pairs / double(samples.size());
      mean.ms += s.ms / double(samples.size());
    }
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
  if (r.series == equal_overlap_series) return r.lights;
  if (r.series == overlap_series) return r.overlap.value_or(0);
  return r.radius_scale;
}

}  // namespace

bool has_cull_time(const FrontierRecord& r) {
  return r.series.empty() && r.refused.empty() && r.pass_ms.contains(cull_pass) &&
         r.point.settings.contains("cull_test");
}

std::vector<BreakEven> break_evens_of(Records records) {
  std::vector<BreakEven> all;
  for (const Group& group :
       grouped(profiled(records), [](const FrontierRecord& r) { return key_on_view(r, cull_test_alone); })) {
    for (size_t a = 0; a < group.size(); ++a) {
      for (size_t b = a + 1; b < group.size(); ++b) all.push_back(break_even_of(*group[a], *group[b]));
    }
  }
  return all;
}

// One slope through groups of samples that each have an intercept of their own: all that differs between the
// samples of a group is the cull test and the depth bounds.
std::vector<ShadingCost> shading_costs_of(Records records) {
  Group shaded = profiled(records);
  std::erase_if(shaded, [](const FrontierRecord* r) { return !shading_ms(*r); });
  std::vector<ShadingCost> costs;
  for (const Group& group : grouped(shaded, [](const FrontierRecord& r) {
         return r.point.scene + "\n" + r.point.technique + "\n" + brdf_of(r);
       })) {
    std::map<std::string, std::vector<PairsAndMs>> samples;
    for (const FrontierRecord* r : group)
      samples[key_on_view(*r, bounds_and_test)].push_back({double(r->pairs.listed), *shading_ms(*r)});
    Deviations of;
    for (const auto& [key, of_group] : samples) of.add(of_group);
    // Nothing varied, or noise outweighs the lists.
    if (of.pairs_squared == 0 || !(of.pairs_ms > 0)) continue;
    const double slope = of.pairs_ms / of.pairs_squared;
    const double residuals = std::max(of.ms_squared - slope * of.pairs_ms, 0.0);
    const double half = of.degrees_of_freedom < 1
                            ? std::numeric_limits<double>::infinity()
                            : student_t_quantile(0.975, of.degrees_of_freedom) *
                                  std::sqrt(residuals / of.degrees_of_freedom / of.pairs_squared);
    const FrontierRecord& first = *group.front();
    costs.push_back({first.point.scene, first.point.technique, brdf_of(first), ns_per_ms * slope,
                     ns_per_ms * (slope - half), ns_per_ms * (slope + half)});
  }
  return costs;
}

std::vector<Growth> growth_of(Records records, const std::string& keep) {
  const Group timed = accepted(records, [](const FrontierRecord& r) {
    return !r.series.empty() && !is_control(r) && r.refused.empty() && !r.frame_ms.empty();
  });
  std::vector<Growth> curves;
  for (const Group& group : grouped(timed, [](const FrontierRecord& r) {
         return r.point.scene + "\n" + r.point.label + "\n" + r.series;
       })) {
    std::map<double, std::vector<double>> medians;  // by x, one a view
    for (const FrontierRecord* r : group)
      medians[place_in_series(*r)].push_back(spread_of(r->frame_ms).median);
    if (medians.size() < 2) continue;
    const FrontierRecord& first = *group.front();
    Growth& curve = curves.emplace_back(Growth{first.point.scene, first.point.label, first.series});
    if (first.series == "lights") curve.kept = keep;
    for (const auto& [x, of_views] : medians) {
      double sum = 0;
      for (const double ms : of_views) sum += ms;
      curve.samples.emplace_back(x, sum / double(of_views.size()));
    }
    const PowerLaw law = power_law(curve.samples);
    curve.exponent = law.exponent;
    curve.low = law.low;
    curve.high = law.high;
  }
  return curves;
}

namespace {

// The smallest difference of an even color that an eye notices is about 0.06.
constexpr double equal_flips[] = {0.001, 0.01, 0.06, 0.2};

// The median of every second round from `first` on; of a single round, of its first frame.
double half_ms(const FrontierRecord& r, size_t first) {
  std::vector<double> half;
  for (size_t run = 0; run < r.frame_ms.size(); ++run) {
    if (run / size_t(r.frames_per_round) % 2 == first) half.push_back(r.frame_ms[run]);
  }
  return half.empty() ? r.frame_ms.front() : median_interval(half).median;
}

// Considers one technique at one place of a family.
std::optional<EqualFlip::Sample> cheapest_of(const Group& points, const std::string& error, double flip) {
  const FrontierRecord* best = nullptr;
  for (const FrontierRecord* r : points) {
    if (r->nan_pixels > 0 || !(flip_of(r->errors, error) <= flip)) continue;
    if (!best || half_ms(*r, 0) < half_ms(*best, 0)) best = r;
  }
  if (!best) return {};
  return EqualFlip::Sample{place_in_series(*best), best->point.label, half_ms(*best, 1)};
}

EqualFlip equal_flip_along(const Group& family, const std::string& error, double flip) {
  const FrontierRecord& first = *family.front();
  EqualFlip curve{first.point.scene, first.point.technique, first.series, error, flip, {}};
  for (const Group& place :
       grouped(family, [](const FrontierRecord& r) { return fmt::format("{}", place_in_series(r)); })) {
    if (const auto sample = cheapest_of(place, error, flip)) curve.samples.push_back(*sample);
  }
  std::ranges::sort(curve.samples, {}, &EqualFlip::Sample::x);
  std::vector<std::pair<double, double>> places;
  for (const EqualFlip::Sample& s : curve.samples) places.emplace_back(s.x, s.ms);
  const PowerLaw law = power_law(places);
  curve.exponent = law.exponent;
  curve.low = law.low;
  curve.high = law.high;
  return curve;
}

}  // namespace

std::vector<EqualFlip> equal_flip_of(Records records) {
  const Group timed = accepted(records, [](const FrontierRecord& r) {
    return is_of_family(r) && r.refused.empty() && !r.frame_ms.empty();
  });
  std::vector<EqualFlip> curves;
  for (const Group& family : grouped(timed, [](const FrontierRecord& r) {
         return r.point.scene + "\n" + r.series + "\n" + r.point.technique;
       })) {
    for (const char* error : front_errors) {
      for (const double flip : equal_flips) {
        EqualFlip curve = equal_flip_along(family, error, flip);
        if (!curve.samples.empty()) curves.push_back(std::move(curve));
      }
    }
  }
  return curves;
}

}  // namespace lightgrid::lab
