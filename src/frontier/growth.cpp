// How frame time grows with lights, pixels and radius; and which points failed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/timer.h"
#include "frontier/answer_steps.h"
#include "frontier/statistics.h"
#include "results/words.h"

namespace lightgrid {
namespace {

double place_in_series(const FrontierRecord& r) {
  if (r.series == "lights") return r.lights;
  if (r.series == "pixels") return double(r.width) * r.height;
  return r.radius_scale;
}

struct Faults {
  FrontierPoint point;
  std::string refused;
  uint64_t lost = 0, wrong = 0, nan_pixels = 0, overflow = 0;
  bool not_finite = false;  // an error that is no number
};

bool errors_are_finite(const PointErrors& errors) {
  return std::isfinite(errors.total.max_rel) && std::isfinite(errors.total.rmse_rel) &&
         std::isfinite(errors.technique.max_rel) && std::isfinite(errors.technique.rmse_rel);
}

}  // namespace

std::string label_in_series(const FrontierRecord& r) {
  if (r.series == "lights")
    return fmt::format("{}, {} lights", r.point.label, with_commas(uint64_t(r.lights)));
  if (r.series == "pixels") return fmt::format("{}, {} × {}", r.point.label, r.width, r.height);
  if (r.series == "radius") return fmt::format("{}, radius × {:g}", r.point.label, r.radius_scale);
  return r.point.label;
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

std::vector<Failure> failures_of(Records records) {
  std::vector<std::string> keys;
  std::map<std::string, Faults> faults;
  for (const FrontierRecord& r : records) {
    const std::string key = point_key(r.point) + label_in_series(r);
    if (!faults.contains(key)) keys.push_back(key);
    Faults& of_point = faults[key];
    of_point.point = r.point;
    of_point.point.label = label_in_series(r);
    if (of_point.refused.empty()) of_point.refused = r.refused;
    if (!r.refused.empty()) continue;
    of_point.lost += r.pairs.lost, of_point.wrong += r.pairs.wrong;
    of_point.nan_pixels += r.nan_pixels, of_point.overflow += r.overflow;
    of_point.not_finite |= !errors_are_finite(r.errors);
  }
  std::vector<Failure> failures;
  for (const std::string& key : keys) {
    const Faults& f = faults[key];
    const auto add = [&](const char* cause, const std::string& why) {
      failures.push_back({f.point, cause, why});
    };
    if (!f.refused.empty()) add("refused", "refused: " + f.refused);
    if (f.lost) add("lost", with_commas(f.lost) + " lit pairs are not listed");
    if (f.wrong) add("wrong", with_commas(f.wrong) + " listed pairs are no light, or twice the same");
    if (f.nan_pixels) {
      add("NaN", with_commas(f.nan_pixels) + " pixels are NaN");
    } else if (f.not_finite) {
      add("NaN", "its error is not finite");
    }
    if (f.overflow) add("overflow", with_commas(f.overflow) + " list entries did not fit");
  }
  return failures;
}

}  // namespace lightgrid
