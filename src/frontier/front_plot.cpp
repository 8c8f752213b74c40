// Error against time, with the front as a step line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frontier/answer_steps.h"
#include "frontier/plot_parts.h"
#include "report/report.h"

namespace lightgrid {
namespace {

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

}  // namespace

void add_front_plot(const FrontierAnswer& answer, const std::string& scene,
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
  const PlotArea area{60, 700, 36, 400};
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

}  // namespace lightgrid
