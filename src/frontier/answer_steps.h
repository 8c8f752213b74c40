// The steps of answer_of: each is a pure function of records, or of what earlier steps found.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "frontier/answer.h"

namespace lightgrid {

using Records = std::span<const FrontierRecord>;

// The settings by which two points differ other than in the keys `without`.
std::map<std::string, std::string> settings_without(const FrontierPoint& point,
                                                    std::span<const std::string> without);

// A technique with settings, as text that is equal for equal points of a scene.
std::string point_key(const FrontierPoint& point, std::span<const std::string> without = {});

// The name of the pass whose times are those of culling, and what pairs of a break-even differ in.
inline constexpr const char* cull_pass = "cull_lights";
inline const std::vector<std::string> cull_test_alone = {"cull_test"};

// Records whose times may be compared: those of another kind of machine (devices, drivers, processor,
// threads) are multiplied by how much longer or shorter the same baseline took on the first kind of machine
// that measured the scene, over the views that both have. Ratios stay as they are. Where no view is on both,
// pass_ms and cull_ms are emptied. Records of one kind of machine are returned unchanged. `machines`: one a
// part, by its shard.
std::vector<FrontierRecord> on_one_machine(std::vector<FrontierRecord> records,
                                           const std::vector<FrontierMachine>& machines);

// Points that ran in each of their views, in the order of their first records; without points of a series.
std::vector<PointFigures> figures_of(Records records);

// Sets front and tied_with. Points with a NaN pixel are never on the front.
void rank_points(std::vector<PointFigures>& points);

// For errors of 1e-6, 1e-5, ... 1e-1 and each scene, where a point is within it.
std::vector<BestWithin> best_within_of(const std::vector<PointFigures>& points);

// Points of `points` whose total error is at most that of points[index] and whose ratio does not differ from
// its own.
std::vector<int> tied_and_no_worse(const std::vector<PointFigures>& points, int index, double error);

std::vector<BreakEven> break_evens_of(Records records);
std::vector<ShadingCost> shading_costs_of(Records records);
std::vector<Growth> growth_of(Records records);
std::vector<Failure> failures_of(Records records);

// One paragraph a scene. A sentence whose figures are missing is left out.
std::vector<std::string> sentences_of_scene(const FrontierAnswer& answer, const std::string& scene);
std::vector<std::string> sentences_of(const FrontierAnswer& answer);

// "forward", or of a series "forward, 10,000 lights".
std::string label_in_series(const FrontierRecord& record);

// "hall" for "scenes/hall.glb".
std::string scene_in_words(const std::string& scene);

// Scenes in the order of their first points.
std::vector<std::string> scenes_of(const FrontierAnswer& answer);

// Three significant digits: "0.310", "31.0", "3,100"; "0" for 0.
std::string three_digits(double value);

std::string error_in_words(double error);  // "1.2e-3", "0"
std::string percent_of(double error);      // "0.1 %"

}  // namespace lightgrid
