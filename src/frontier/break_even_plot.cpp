// The shading costs from which tighter cull tests win, as bars, and this machine's costs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frontier/answer_steps.h"
#include "frontier/plot_parts.h"
#include "report/report.h"

namespace lightgrid {
namespace {

// "exact over sphere, tile=8": labels that differ in the cull test, in short.
std::string pair_in_words(const FrontierAnswer& answer, const BreakEven& pair) {
  const auto test_of = [&](const std::string& label) {
    for (const FrontierRecord& r : answer.part.records) {
      const auto test = r.point.settings.find("cull_test");
      if (r.point.scene == pair.scene && r.point.label == label && test != r.point.settings.end())
        return test->second;
    }
    return label;
  };
  std::string others;  // further settings of the label
  std::string item;
  for (const char c : pair.tighter + ",") {
    if (c != ',' && c != ':') {
      item += c;
      continue;
    }
    const bool is_test = item.starts_with("cull-test=") || item.starts_with("cull_test=");
    if (!is_test && item != technique_of(pair.tighter)) others += ", " + item;
    item.clear();
  }
  return fmt::format("{} over {}{}", test_of(pair.tighter), test_of(pair.looser), others);
}

}  // namespace

void add_break_even_plot(const FrontierAnswer& answer, const std::string& scene, const std::string& technique,
                         std::vector<Plot>& plots) {
  std::vector<const BreakEven*> pairs;
  std::vector<double> costs = {0};  // a place for tests that always win
  for (const BreakEven& pair : answer.break_even) {
    if (pair.scene != scene || technique_of(pair.tighter) != technique) continue;
    pairs.push_back(&pair);
    costs.push_back(pair.ns_per_pixel_light);
    if (pair.rounds > 0) costs.push_back(pair.low), costs.push_back(pair.high);
  }
  if (pairs.empty()) return;
  std::vector<const ShadingCost*> marks;
  for (const ShadingCost& cost : answer.shading_costs) {
    if (cost.scene == scene && cost.technique == technique)
      marks.push_back(&cost), costs.push_back(cost.ns_per_pixel_light);
  }
  const auto cheaper = [](const auto* a, const auto* b) {
    return a->ns_per_pixel_light < b->ns_per_pixel_light;
  };
  std::sort(marks.begin(), marks.end(), cheaper);
  std::stable_sort(pairs.begin(), pairs.end(), cheaper);
  const double row = 34, top = 14 + 16.0 * double(marks.size());
  const PlotArea area{16, 544, top, top + row * double(pairs.size())};
  Plot plot{"break-even", scene, fmt::format("break-even-{}-{}", file_stem(scene_in_words(scene)), technique),
            fmt::format("{}, {}: shading cost from which the tighter cull test wins", scene_in_words(scene),
                        technique),
            ""};
  Svg svg(560, int(area.bottom + 46), plot.title);
  const LogAxis x(costs, area.left, area.right);
  for (const double value : x.ticks()) {
    svg.line(x.at(value), area.top, x.at(value), area.bottom, "rule");
    svg.text(x.at(value), area.bottom + 16, "middle", tick_text(value));
  }
  svg.text(x.at(0), area.bottom + 16, "middle", "0");
  svg.text((area.left + area.right) / 2, area.bottom + 36, "middle", "ns a pixel and light");
  for (size_t i = 0; i < pairs.size(); ++i) {
    const BreakEven& pair = *pairs[i];
    const double y = area.top + row * double(i), cost = pair.ns_per_pixel_light;
    const std::string words = pair_in_words(answer, pair);
    const std::string wins = std::isinf(cost) ? "never"
                             : cost == 0      ? "always"
                                              : "from " + three_digits(cost) + " ns";
    const std::string interval =
        pair.rounds > 0 ? fmt::format(" ({} to {})", three_digits(pair.low), three_digits(pair.high)) : "";
    svg.text(area.left, y + 14, "start", words + ": " + wins + interval);
    if (std::isinf(cost)) continue;
    svg.bar(x.at(cost), y + 19, area.right - x.at(cost), 9,
            fmt::format("{}: {}{}. Culling takes {} ms more a view and lists {} fewer pairs", words, wins,
                        interval, three_digits(pair.extra_ms), three_digits(pair.pairs_saved)));
    if (pair.rounds > 0) {
      svg.line(x.at(pair.low), y + 23.5, x.at(pair.high), y + 23.5, "interval");
      for (const double end : {pair.low, pair.high})
        svg.line(x.at(end), y + 19, x.at(end), y + 28, "interval");
    }
  }
  for (size_t i = 0; i < marks.size(); ++i) {
    const double at = x.at(marks[i]->ns_per_pixel_light), y = 12 + 16.0 * double(i);
    svg.line(at, y + 4, at, area.bottom, "machine");
    const std::string words =
        fmt::format("{} ns{} on this machine", three_digits(marks[i]->ns_per_pixel_light),
                    marks[i]->brdf.empty() ? "" : " with " + marks[i]->brdf);
    const bool fits = at + 7.0 * double(words.size()) < area.right;
    svg.text(at, y, fits ? "start" : "end", words, "machine-name");
  }
  plot.svg = svg.end();
  plots.push_back(plot);
}

}  // namespace lightgrid
