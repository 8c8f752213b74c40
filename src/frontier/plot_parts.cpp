#include "frontier/plot_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lightgrid {

std::string svg_escaped(const std::string& text) {
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

LogAxis::LogAxis(const std::vector<double>& values, double from, double to)
    : zero_(from), from_(from), to_(to) {
  double least = HUGE_VAL, most = 0;
  for (const double value : values) {
    if (value == 0) has_zero_ = true;
    if (!(value > 0) || std::isinf(value)) continue;
    least = std::min(least, value), most = std::max(most, value);
  }
  if (most == 0) least = most = 1;
  low_ = least / 1.3, high_ = most * 1.3;
  if (has_zero_) from_ += (to > from ? 1 : -1) * 36;
}

double LogAxis::at(double value) const {
  if (value == 0) return zero_;
  return from_ + std::log(value / low_) / std::log(high_ / low_) * (to_ - from_);
}

std::vector<double> LogAxis::ticks() const {
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

Svg::Svg(int width, int height, const std::string& title)
    : text_(fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width,
                        height, svg_escaped(title))) {}

void Svg::line(double x1, double y1, double x2, double y2, const char* kind) {
  text_ += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind,
                       x1, y1, x2, y2);
}

void Svg::text(double x, double y, const char* anchor, const std::string& words, const char* kind) {
  text_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", kind, x,
                       y, anchor, svg_escaped(words));
}

void Svg::bar(double x, double y, double width, double height, const std::string& title) {
  text_ += fmt::format(
      "<rect class=\"wins\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "rx=\"2\"><title>{}</title></rect>\n",
      x, y, width, height, svg_escaped(title));
}

void Svg::marker(double x, double y, const TechniqueStyle& style, const std::string& title, bool hollow) {
  text_ += fmt::format(
      "<path d=\"{}\" transform=\"translate({:.1f} {:.1f})\" fill=\"{}\" stroke=\"{}\" "
      "stroke-width=\"1.5\"><title>{}</title></path>\n",
      style.marker, x, y, hollow ? "none" : style.colour, style.colour, svg_escaped(title));
}

void Svg::lines_through(const std::vector<std::pair<double, double>>& places, const std::string& colour) {
  text_ += "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\" points=\"";
  for (const auto& [x, y] : places) text_ += fmt::format("{:.1f},{:.1f} ", x, y);
  text_ += "\"/>\n";
}

const TechniqueStyle& style_of(const std::vector<TechniqueStyle>& styles, const std::string& technique) {
  static const TechniqueStyle none{"", "#8a857c", circle_marker};
  const auto found = std::find_if(styles.begin(), styles.end(),
                                  [&](const TechniqueStyle& s) { return s.technique == technique; });
  return found == styles.end() ? none : *found;
}

std::string technique_of(const std::string& label) { return label.substr(0, label.find(':')); }

void draw_axes(Svg& svg, const PlotArea& area, const LogAxis& x, const LogAxis& y, const std::string& x_name,
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

double legend_height(size_t names) { return 20.0 * double((names + 2) / 3); }

void draw_legend(Svg& svg, const std::vector<TechniqueStyle>& shown, double left, double top, double width) {
  for (size_t i = 0; i < shown.size(); ++i) {
    const double x = left + double(i % 3) * width / 3, y = top + 20.0 * double(i / 3);
    svg.marker(x + 6, y, shown[i], shown[i].technique);
    svg.text(x + 18, y + 4, "start", shown[i].technique);
  }
}

}  // namespace lightgrid
