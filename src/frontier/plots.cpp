#include "frontier/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "frontier/answer_steps.h"
#include "frontier/statistics.h"
#include "report/report.h"

namespace lightgrid {
namespace {

// Those of report/page/elements.js.
constexpr const char* palette[] = {"#3b6fb6", "#d9822b", "#3f9b58", "#b5475d", "#7d5bb0",
                                   "#2a9aa0", "#a5762c", "#c25aa0", "#6b8e23", "#4e5fa8",
                                   "#8c564b", "#17a2d4", "#c7a008", "#e2664f"};

struct FamilyMarker {
  const char *family, *marker;
};
constexpr FamilyMarker family_markers[] = {
    {"deferred", "M-4.5,-4.5h9v9h-9z"},
    {"clustered", "M0,-5.5L5.2,4.2H-5.2z"},
    {"lidr", "M0,-6L6,0L0,6L-6,0z"},
    {"world", "M-6,-2.5h12v5h-12z"},
    {"voxel", "M-5,-3L0,-6L5,-3V3L0,6L-5,3z"},
    {"visibility", "M-2,-5.5h4v3.5h3.5v4h-3.5v3.5h-4v-3.5h-3.5v-4h3.5z"},
};
constexpr const char* circle = "M-5,0a5,5 0 1,0 10,0a5,5 0 1,0 -10,0z";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string tick_text(double value) {
  return value >= 0.0099 && value < 99999 ? fmt::format("{:g}", value)
                                          : fmt::format("1e{}", std::lround(std::log10(value)));
}

// A logarithmic axis of an SVG. A value of 0 has a place of its own before its begin.
class LogAxis {
 public:
  LogAxis(const std::vector<double>& values, double from, double to) : zero_(from), from_(from), to_(to) {
    double least = HUGE_VAL, most = 0;
    bool has_zero = false;
    for (const double value : values) {
      if (value == 0) has_zero = true;
      if (!(value > 0) || std::isinf(value)) continue;
      least = std::min(least, value), most = std::max(most, value);
    }
    if (most == 0) least = most = 1;
    low_ = least / 1.3, high_ = most * 1.3;
    if (has_zero) from_ += (to > from ? 1 : -1) * 36, has_zero_ = true;
  }
  double at(double value) const {
    if (value == 0) return zero_;
    return from_ + std::log(value / low_) / std::log(high_ / low_) * (to_ - from_);
  }
  // 1, 2, 5 of each decade, or decades alone where there are many.
  std::vector<double> ticks() const {
    const double decades = std::log10(high_ / low_);
    std::vector<double> values;
    for (int decade = int(std::floor(std::log10(low_))); decade <= int(std::ceil(std::log10(high_)));
         ++decade) {
      if (decades > 8 && decade % 2 != 0) continue;
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double value = digit * std::pow(10, decade);
        if ((digit == 1 || decades < 2) && value >= low_ && value <= high_) values.push_back(value);
      }
    }
    return values;
  }
  bool has_zero() const { return has_zero_; }

 private:
  double zero_, from_, to_, low_ = 1, high_ = 1;
  bool has_zero_ = false;
};

class Svg {
 public:
  Svg(int width, int height, const std::string& title)
      : text_(fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                          width, height, escaped(title))) {}
  void line(double x1, double y1, double x2, double y2, const char* kind) {
    text_ += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                         kind, x1, y1, x2, y2);
  }
  void text(double x, double y, const char* anchor, const std::string& words, const char* kind = "") {
    text_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", kind,
                         x, y, anchor, escaped(words));
  }
  void bar(double x, double y, double width, double height, const std::string& title) {
    text_ += fmt::format(
        "<rect class=\"wins\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "rx=\"2\"><title>{}</title></rect>\n",
        x, y, width, height, escaped(title));
  }
  void marker(double x, double y, const TechniqueStyle& style, const std::string& title,
              bool hollow = false) {
    text_ += fmt::format(
        "<path d=\"{}\" transform=\"translate({:.1f} {:.1f})\" fill=\"{}\" stroke=\"{}\" "
        "stroke-width=\"1.5\"><title>{}</title></path>\n",
        style.marker, x, y, hollow ? "none" : style.colour, style.colour, escaped(title));
  }
  void lines_through(const std::vector<std::pair<double, double>>& places, const std::string& colour) {
    text_ += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\" points=\"";
    for (const auto& [x, y] : places) text_ += fmt::format("{:.1f},{:.1f} ", x, y);
    text_ += "\"/>\n";
  }
  std::string end() { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

const TechniqueStyle& style_of(const std::vector<TechniqueStyle>& styles, const std::string& technique) {
  static const TechniqueStyle none{"", "#8a857c", circle};
  const auto found = std::find_if(styles.begin(), styles.end(),
                                  [&](const TechniqueStyle& s) { return s.technique == technique; });
  return found == styles.end() ? none : *found;
}

struct Area {
  double left, right, top, bottom;
};

void draw_axes(Svg& svg, const Area& area, const LogAxis& x, const LogAxis& y, const std::string& x_name,
               const std::string& y_name) {
  for (const double value : x.ticks()) {
    svg.line(x.at(value), area.top, x.at(value), area.bottom, "rule");
    svg.text(x.at(value), area.bottom + 16, "middle", tick_text(value));
  }
  for (const double value : y.ticks()) {
    svg.line(area.left, y.at(value), area.right, y.at(value), "rule");
    svg.text(area.left - 6, y.at(value) + 4, "end", tick_text(value));
  }
  if (x.has_zero())
    svg.line(x.at(0), area.top, x.at(0), area.bottom, "rule zero"),
        svg.text(x.at(0), area.bottom + 16, "middle", "0");
  if (y.has_zero())
    svg.line(area.left, y.at(0), area.right, y.at(0), "rule zero"),
        svg.text(area.left - 6, y.at(0) + 4, "end", "0");
  svg.text((area.left + area.right) / 2, area.bottom + 36, "middle", x_name);
  svg.text(area.left - 44, area.top - 10, "start", y_name);
}

// Names with their markers, in columns below a plot; returns the height.
double legend_height(size_t names) { return 20.0 * double((names + 2) / 3); }
void draw_legend(Svg& svg, const std::vector<TechniqueStyle>& shown, double left, double top, double width) {
  for (size_t i = 0; i < shown.size(); ++i) {
    const double x = left + double(i % 3) * width / 3, y = top + 20.0 * double(i / 3);
    svg.marker(x + 6, y, shown[i], shown[i].technique);
    svg.text(x + 18, y + 4, "start", shown[i].technique);
  }
}

std::string point_title(const FrontierAnswer& answer, const PointFigures& p) {
  return fmt::format("{}: {} times {} ({} to {}), error {}", p.point.label, three_digits(p.ratio.median),
                     answer.part.baseline, three_digits(p.ratio.low), three_digits(p.ratio.high),
                     error_in_words(p.errors.total.rmse_rel));
}

// The step line of the front: from a point, right to the next slower one, then down to its error.
std::vector<std::pair<double, double>> front_steps(const std::vector<const PointFigures*>& points,
                                                   const LogAxis& x, const LogAxis& y) {
  std::vector<const PointFigures*> front;
  std::copy_if(points.begin(), points.end(), std::back_inserter(front),
               [](const PointFigures* p) { return p->front; });
  std::sort(front.begin(), front.end(),
            [](const auto* a, const auto* b) { return a->ratio.median < b->ratio.median; });
  std::vector<std::pair<double, double>> steps;
  for (const PointFigures* p : front) {
    const double at_x = x.at(p->ratio.median), at_y = y.at(p->errors.total.rmse_rel);
    if (!steps.empty()) steps.emplace_back(at_x, steps.back().second);
    steps.emplace_back(at_x, at_y);
  }
  return steps;
}

void add_front(const FrontierAnswer& answer, const std::string& scene,
               const std::vector<TechniqueStyle>& styles, std::vector<Plot>& plots) {
  std::vector<const PointFigures*> points;
  std::vector<double> ratios, errors;
  for (const PointFigures& p : answer.points) {
    if (p.point.scene != scene || p.ratios.empty() || !std::isfinite(p.errors.total.rmse_rel)) continue;
    points.push_back(&p);
    ratios.push_back(p.ratio.median), errors.push_back(p.errors.total.rmse_rel);
  }
  if (points.empty()) return;
  std::vector<TechniqueStyle> shown;
  for (const TechniqueStyle& s : styles) {
    const bool used = std::any_of(points.begin(), points.end(),
                                  [&](const auto* p) { return p->point.technique == s.technique; });
    if (used) shown.push_back(s);
  }
  const Area area{60, 700, 36, 400};
  Plot plot{"front", scene, "front-" + file_stem(scene_in_words(scene)),
            "Error against time: " + scene_in_words(scene), ""};
  Svg svg(720, int(460 + legend_height(shown.size())), plot.title);
  const LogAxis x(ratios, area.left, area.right), y(errors, area.bottom, area.top);
  draw_axes(svg, area, x, y, "time, over " + answer.part.baseline + "'s", "RMSE over the brightest channel");
  svg.lines_through(front_steps(points, x, y), "var(--ink)");
  for (const PointFigures* p : points) {
    svg.marker(x.at(p->ratio.median), y.at(p->errors.total.rmse_rel), style_of(styles, p->point.technique),
               point_title(answer, *p), !p->front);
  }
  draw_legend(svg, shown, area.left, area.bottom + 64, area.right - area.left);
  plot.svg = svg.end();
  plots.push_back(plot);
}

std::string technique_of(const std::string& label) { return label.substr(0, label.find(':')); }

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

void add_break_even_plot(const FrontierAnswer& answer, const std::string& scene, const std::string& technique,
                         std::vector<Plot>& plots) {
  std::vector<const BreakEven*> pairs;
  std::vector<double> costs = {0};  // a place for tests that always win
  for (const BreakEven& pair : answer.break_even) {
    if (pair.scene != scene || technique_of(pair.tighter) != technique) continue;
    pairs.push_back(&pair);
    costs.push_back(pair.ns_per_pixel_light);
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
  const Area area{16, 544, top, top + row * double(pairs.size())};
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
    svg.text(area.left, y + 14, "start", words + ": " + wins);
    if (std::isinf(cost)) continue;
    svg.bar(x.at(cost), y + 19, area.right - x.at(cost), 9,
            fmt::format("{}: {}. Culling takes {} ms more a view and lists {} fewer pairs", words, wins,
                        three_digits(pair.extra_ms), three_digits(pair.pairs_saved)));
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

void add_growth_plots(const FrontierAnswer& answer, const std::string& scene,
                      const std::vector<TechniqueStyle>& styles, std::vector<Plot>& plots) {
  for (const char* of : {"lights", "pixels", "radius"}) {
    std::vector<const Growth*> curves;
    std::vector<double> xs, times;
    for (const Growth& g : answer.growth) {
      if (g.scene != scene || g.of != of) continue;
      curves.push_back(&g);
      for (const auto& [value, ms] : g.samples) xs.push_back(value), times.push_back(ms);
    }
    if (curves.empty()) continue;
    const Area area{60, 540, 36, 320};
    Plot plot{"growth", scene, fmt::format("growth-{}-{}", of, file_stem(scene_in_words(scene))),
              fmt::format("Time over {}: {}", of, scene_in_words(scene)), ""};
    Svg svg(560, int(390 + 20 * curves.size()), plot.title);
    const LogAxis x(xs, area.left, area.right), y(times, area.bottom, area.top);
    draw_axes(svg, area, x, y, std::string(of) == "radius" ? "radius, over the scene's" : of, "ms a frame");
    for (size_t i = 0; i < curves.size(); ++i) {
      const Growth& g = *curves[i];
      const TechniqueStyle& style = style_of(styles, technique_of(g.technique));
      const PowerLaw law = power_law(g.samples);
      const double first = g.samples.front().first, last = g.samples.back().first;
      svg.lines_through({{x.at(first), y.at(law.factor * std::pow(first, law.exponent))},
                         {x.at(last), y.at(law.factor * std::pow(last, law.exponent))}},
                        style.colour);
      for (const auto& [value, ms] : g.samples) {
        svg.marker(x.at(value), y.at(ms), style,
                   fmt::format("{}, {} {}: {} ms", g.technique, three_digits(value), of, three_digits(ms)));
      }
      const double line = area.bottom + 64 + 20.0 * double(i);
      svg.marker(area.left + 6, line - 4, style, g.technique);
      const std::string interval = std::isfinite(g.low) && std::isfinite(g.high)
                                       ? fmt::format(" ({:.2f} to {:.2f})", g.low, g.high)
                                       : "";
      svg.text(area.left + 20, line, "start",
               fmt::format("{}: exponent {:.2f}{}", g.technique, g.exponent, interval));
    }
    plot.svg = svg.end();
    plots.push_back(plot);
  }
}

}  // namespace

std::vector<TechniqueStyle> technique_styles(const FrontierAnswer& answer) {
  std::vector<TechniqueStyle> styles;
  for (const FrontierRecord& r : answer.part.records) {
    const std::string& name = r.point.technique;
    if (std::any_of(styles.begin(), styles.end(),
                    [&](const TechniqueStyle& s) { return s.technique == name; }))
      continue;
    const std::string family = name.substr(0, name.find('_'));
    const auto marker = std::find_if(std::begin(family_markers), std::end(family_markers),
                                     [&](const FamilyMarker& m) { return m.family == family; });
    styles.push_back({name, palette[styles.size() % std::size(palette)],
                      marker == std::end(family_markers) ? circle : marker->marker});
  }
  return styles;
}

std::vector<Plot> plots_of(const FrontierAnswer& answer) {
  const std::vector<TechniqueStyle> styles = technique_styles(answer);
  std::vector<Plot> plots;
  for (const std::string& scene : scenes_of(answer)) {
    add_front(answer, scene, styles, plots);
    for (const TechniqueStyle& style : styles) add_break_even_plot(answer, scene, style.technique, plots);
    add_growth_plots(answer, scene, styles, plots);
  }
  std::vector<std::string> names;
  for (const Plot& plot : plots) names.push_back(plot.name);
  names = file_stems(names);
  for (size_t i = 0; i < plots.size(); ++i) plots[i].name = names[i];
  return plots;
}

std::string svg_file(const Plot& plot) {
  const std::string style = R"(<style>
svg { --ink: #1c1b19; --quiet: #66625b; --line: #dedad3; --accent: #b4540a; --good: #1f7a3d; background: #ffffff; font-family: system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { svg { --ink: #eeebe6; --quiet: #a39d93; --line: #3a3733; --accent: #f2a154; --good: #6fcf8d; background: #1f1d1b; } }
text { fill: var(--quiet); font-size: 12px; }
.rule { stroke: var(--line); }
.zero { stroke-dasharray: 3 3; }
.wins { fill: var(--good); opacity: 0.55; }
.machine { stroke: var(--accent); stroke-width: 1.5; }
.machine-name { fill: var(--accent); }
</style>
)";
  std::string text = plot.svg;
  text.insert(text.find("viewBox"), "xmlns=\"http://www.w3.org/2000/svg\" ");
  return text.insert(text.find('\n') + 1, style + "<title>" + escaped(plot.title) + "</title>\n");
}

}  // namespace lightgrid
