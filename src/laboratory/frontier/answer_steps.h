// The steps of answer_of, each a pure function of records or of what earlier steps found, and their
// statistics.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "frontier/answer.h"
#include "measures/error_measures.h"
#include "measures/ratio_of_times.h"

namespace lightgrid::lab {

using Records = std::span<const FrontierRecord>;
using Group = std::vector<const FrontierRecord*>;

// The records that a test accepts, in their order.
Group accepted(Records records, const std::function<bool(const FrontierRecord& record)>& test);

// Groups of equal keys, in the order of their first records.
std::vector<Group> grouped(const Group& records,
                           const std::function<std::string(const FrontierRecord& record)>& key_of);

// A technique with settings other than those of the keys `without`, as text that is equal for equal points of
// a scene.
std::string point_key(const FrontierPoint& point, std::span<const std::string> without = {});

// The name of the pass whose times are those of culling, and what pairs of a break-even differ in.
inline constexpr const char* cull_pass = "cull_lights";
inline const std::vector<std::string> cull_test_alone = {"cull_test"};
bool has_cull_time(const FrontierRecord& record);  // a point of the front that ran, with a cull test

// Records whose times may be compared: those of another kind of machine (devices, drivers, processor,
// threads) are multiplied by how much longer or shorter the same baseline took on the first kind of machine
// that measured the scene, over the views that both have. Ratios stay as they are. Where no view is on both,
// pass_ms and cull_ms are emptied. Records of one kind of machine are returned unchanged. `machines`: one a
// part, by its shard.
std::vector<FrontierRecord> on_one_machine(std::vector<FrontierRecord> records,
                                           const std::vector<FrontierMachine>& machines);

// The same records, timed by the devices' clocks: frame_ms and baseline_ms are device_ms and
// baseline_device_ms. Without times where a run of one of the point's views lacks them.
std::vector<FrontierRecord> by_device_clock(std::vector<FrontierRecord> records);

// The same, with the processor's time.
std::vector<FrontierRecord> by_cpu_clock(std::vector<FrontierRecord> records);

// Sets what is known by the devices' clocks and by the processor's time, of points of the same records, and
// which clock decides in each scene; their wall-clock figures are set.
void set_device_figures(FrontierAnswer& answer);
void set_cpu_figures(FrontierAnswer& answer);
Clock clock_of_scene(const FrontierAnswer& answer, const std::string& scene);

// Returns whether a point with this label draws without OpenGL; false for an unknown technique.
bool draws_in_opencl(const std::string& label);
std::vector<AmongOpenCl> among_opencl_of(const FrontierAnswer& answer);

// Points that ran in each of their views, in the order of their first records; without points of a series.
std::vector<PointFigures> figures_of(Records records);
// Sets `frame_ms` and `times`, of records of the same points with other times.
void set_times(std::vector<PointFigures>& points, Records records);

// One a process of a part that took times.
std::vector<ProcessConditions> process_conditions_of(const std::vector<FrontierPart>& parts);

// One a scene that has one.
std::vector<Control> controls_of(Records records);
// Sets the points' relative times, widened as their scenes' controls ask.
void set_relative_times(std::vector<PointFigures>& points, const std::vector<Control>& controls);

// Sets `fronts`. Points with a NaN pixel are never on one.
void rank_points(std::vector<PointFigures>& points, const std::vector<Control>& controls);
std::vector<FrontBand> front_bands_of(const std::vector<PointFigures>& points,
                                      const std::vector<Control>& controls);

// For FLIPs of 0.001 to 0.2 and each scene and error that fronts are of, where a point is within it.
std::vector<CheapestWithin> cheapest_within_of(const std::vector<PointFigures>& points,
                                               const std::vector<Control>& controls);

std::vector<BreakEven> break_evens_of(Records records);
std::vector<ShadingCost> shading_costs_of(Records records);
std::vector<Growth> growth_of(Records records, const std::string& keep = "");
// Over the shards of the parts.
std::vector<Coverage> coverage_of(const std::vector<FrontierPart>& parts,
                                  const std::vector<PointFigures>& points);
std::vector<EqualFlip> equal_flip_of(Records records);
std::vector<Failure> failures_of(Records records);

// One paragraph a scene. A sentence whose figures are missing is left out.
std::vector<std::string> sentences_of(const FrontierAnswer& answer);

// The page's sentences above and below a scene's table of errors.
struct SceneWords {
  std::vector<std::string> opening, notes;
};
SceneWords words_of_scene(const FrontierAnswer& answer, const std::string& scene);

// "hall" for "scenes/hall.glb".
std::string scene_in_words(const std::string& scene);

// The texts that `text_of` gives for the items, each text once, in the order of the items.
template <typename Items, typename TextOf>
std::vector<std::string> distinct(const Items& items, const TextOf& text_of) {
  std::vector<std::string> texts;
  for (const auto& item : items) {
    const std::string text = text_of(item);
    if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
  }
  return texts;
}

// Scenes in the order of their first points.
std::vector<std::string> scenes_of(const FrontierAnswer& answer);

// Three significant digits: "0.310", "31.0", "3,100"; "0" for 0.
std::string three_digits(double value);

// The median and its 95 % confidence interval by order statistics of the binomial distribution (Hollander,
// Wolfe and Chicken, Nonparametric Statistical Methods, 2014). Below six samples no such interval exists: it
// is the whole range. NaN samples are left out everywhere. Throws nothing; zeros without samples.
MedianInterval median_interval(std::span<const double> samples);

// The figure of a scene of which `figures` are of single views: 2.5 and 97.5 % of 2,000 draws of as many
// views with replacement, the same views for every call with as many figures (percentile bootstrap; Efron
// 1979). NaN if a figure is not finite.
std::pair<double, double> bootstrap_interval(const std::vector<double>& figures, OverViews how);

// For points (x, y), smaller is better in both: true where no other point is at most as large in both and
// smaller in one. Points that are equal in both are all on the front. NaN and infinite points never are.
std::vector<bool> pareto_front(std::span<const std::pair<double, double>> points);

// The exponent b of y = c x^b through samples by least squares in logarithms, and its 95 % interval
// (Student's t). Samples that are not positive and finite are left out. Fewer than three distinct x: low and
// high are infinite; fewer than two: exponent and factor are zero.
struct PowerLaw {
  double exponent = 0, low = 0, high = 0, factor = 0;
};
PowerLaw power_law(std::span<const std::pair<double, double>> samples);

}  // namespace lightgrid::lab
