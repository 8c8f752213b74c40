// Time over lights, pixels and radius, with fitted powers.
#include <fmt/format.h>

#include <cmath>

#include "frontier/answer_steps.h"
#include "frontier/plot_parts.h"
#include "frontier/statistics.h"
#include "report/report.h"

namespace lightgrid {

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
    const PlotArea area{60, 540, 36, 320};
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

}  // namespace lightgrid
