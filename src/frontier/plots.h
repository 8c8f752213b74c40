// The answer as SVG: error against time, break-even, growth. The page shows the latter two as they are and
// draws the first by script, since its axes can be chosen.
#pragma once

#include <string>
#include <vector>

#include "frontier/answer.h"

namespace lightgrid {

// How points of a technique are drawn: color by technique, marker by family (forward, deferred, clustered,
// lidr, visibility).
struct TechniqueStyle {
  std::string technique;
  std::string colour;
  std::string marker;  // data of an SVG path around (0, 0), about 10 wide
};

std::vector<TechniqueStyle> technique_styles(const FrontierAnswer& answer);

struct Plot {
  std::string kind;   // "front", "break-even" or "growth"
  std::string scene;  // as in the records
  std::string name;   // of its file, without extension: "front-hall"; distinct
  std::string title;
  std::string svg;  // an <svg> element for a page with report/page/style.css
};

// All plots that have anything to show, by scene.
std::vector<Plot> plots_of(const FrontierAnswer& answer);

// The text of an .svg file: the same with its own colors, light and dark.
std::string svg_file(const Plot& plot);

}  // namespace lightgrid
