// Frame time as curves over a varied quantity, and where two curves cross.
#pragma once

#include <string>
#include <vector>

#include "report/report.h"

namespace lightgrid::lab {

struct CurvePoint {
  double x = 0;
  double ms = 0, least_ms = 0;  // median and least of the runs
  bool exact = true;            // is_exact
  size_t view = 0, row = 0;     // indices in the report
};

struct Curve {
  std::string name;
  std::vector<CurvePoint> points;  // by rising x
  bool flat = false;               // one measurement, drawn over the whole axis: the technique does not read
                                   // the setting
};

// Where two curves cross: below `x`, `below` is the faster of the two.
struct Crossing {
  std::string below, above;
  double x = 0, ms = 0;
  bool lead = false;  // both are exact there, and no exact curve is faster
};

struct Tick {
  double x = 0;
  std::string label;
};

struct Chart {
  std::string title;  // "hall, 1280 × 720"
  std::string axis;   // "lights", "pixels", or a setting: "lidr-overlap"
  std::string kept;   // over lights: kept_in_words
  std::vector<Tick> ticks;
  std::vector<Curve> curves;
  std::vector<Crossing> crossings;     // by rising x
  std::vector<std::string> sentences;  // which technique is fastest in which range
};

// Straight lines between measured points, on logarithmic axes. Two curves cross between neighbouring x of
// both if the order of their medians changes clearly: on both sides the median of the faster is below every
// run of the slower. Otherwise the order is noise.
std::vector<Crossing> crossings_of(const std::vector<Curve>& curves);

// The property that views with several numbers of lights share: "all with the ranges of 300 lights". Empty:
// there is a single number.
std::string kept_in_words(const CompareReport& report);

// Over lights and over pixels: a chart for each group of views that differ in that alone. Axes are
// logarithmic: views without lights are omitted from the former.
std::vector<Chart> charts_over_views(const std::vector<ReportView>& views);

// Over each numeric setting in which rows of a technique differ, within one view. Rows that do not read it
// are flat if they are exact, and omitted otherwise.
std::vector<Chart> charts_over_settings(const std::vector<ReportView>& views, size_t view);

}  // namespace lightgrid::lab
