// Frame time as a curve over what a report varies, and where two curves cross.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid {

struct CurvePoint {
  double x = 0;
  double ms = 0, least_ms = 0;  // median and least of the runs
  bool exact = true;            // is_exact
  size_t view = 0, row = 0;     // where it stands in the report
};

struct Curve {
  std::string name;
  std::vector<CurvePoint> points;  // by rising x
  bool flat = false;               // one measurement, drawn over the whole axis: the technique does not read the setting
};

// Where two curves change places: below `x`, `below` is the faster of the two.
struct Crossing {
  std::string below, above;
  double x = 0, ms = 0;
  bool lead = false;  // both are exact there, and none that is exact is faster
};

struct Tick {
  double x = 0;
  std::string label;
};

struct Chart {
  std::string title;  // "hall, 1280 × 720"
  std::string axis;   // "lights", "pixels", or a setting: "lidr-overlap"
  std::vector<Tick> ticks;
  std::vector<Curve> curves;
  std::vector<Crossing> crossings;     // by rising x
  std::vector<std::string> sentences;  // which is fastest where
};

// Straight lines between measured points, on logarithmic axes. Two curves cross between neighbouring x that both have
// where the order of their medians changes, and it changes clearly: on both sides the median of the faster is below
// every run of the slower. Within that, the order is noise.
std::vector<Crossing> crossings_of(const std::vector<Curve>& curves);

// Over lights and over pixels: a chart for each group of views that differ in that alone. x is above 0 on a logarithmic
// axis: views without lights are left out of the former.
std::vector<Chart> charts_over_views(const std::vector<ReportView>& views);

// Over each numeric setting in which rows of a technique differ, within one view. Rows that do not read it are flat
// where they are exact, and else left out.
std::vector<Chart> charts_over_settings(const std::vector<ReportView>& views, size_t view);

}  // namespace lightgrid
