// What the plots of a frontier are drawn with: axes, marks, lines and text of an SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "frontier/plots.h"

namespace lightgrid {

// Text that stands between tags and within quotes.
std::string svg_escaped(const std::string& text);

// A logarithmic axis of an SVG. A value of 0 has a place of its own before its begin.
class LogAxis {
 public:
  LogAxis(const std::vector<double>& values, double from, double to);
  double at(double value) const;
  // 1, 2, 5 of each decade, or decades alone where there are many.
  std::vector<double> ticks() const;
  bool has_zero() const { return has_zero_; }

 private:
  double zero_, from_, to_, low_ = 1, high_ = 1;
  bool has_zero_ = false;
};

std::string tick_text(double value);

// Lengths in pixels, from the top left.
class Svg {
 public:
  Svg(int width, int height, const std::string& title);
  void line(double x1, double y1, double x2, double y2, const char* kind);
  void text(double x, double y, const char* anchor, const std::string& words, const char* kind = "");
  void bar(double x, double y, double width, double height, const std::string& title);
  void marker(double x, double y, const TechniqueStyle& style, const std::string& title, bool hollow = false);
  void lines_through(const std::vector<std::pair<double, double>>& places, const std::string& colour);
  std::string end() { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

struct PlotArea {
  double left, right, top, bottom;
};

void draw_axes(Svg& svg, const PlotArea& area, const LogAxis& x, const LogAxis& y, const std::string& x_name,
               const std::string& y_name);

// Names with their markers, in columns below a plot.
double legend_height(size_t names);
void draw_legend(Svg& svg, const std::vector<TechniqueStyle>& shown, double left, double top, double width);

inline constexpr const char* circle_marker = "M-5,0a5,5 0 1,0 10,0a5,5 0 1,0 -10,0z";

// Of a technique that has none: a grey circle.
const TechniqueStyle& style_of(const std::vector<TechniqueStyle>& styles, const std::string& technique);

// "forward_plus" for "forward_plus:tile=8".
std::string technique_of(const std::string& label);

// The plots of a scene, if they have anything to show, are appended to `plots`.
void add_front_plot(const FrontierAnswer& answer, const std::string& scene,
                    const std::vector<TechniqueStyle>& styles, std::vector<Plot>& plots);
void add_break_even_plot(const FrontierAnswer& answer, const std::string& scene, const std::string& technique,
                         std::vector<Plot>& plots);
void add_growth_plots(const FrontierAnswer& answer, const std::string& scene,
                      const std::vector<TechniqueStyle>& styles, std::vector<Plot>& plots);

}  // namespace lightgrid
