// Measures a scene's points: errors on each view of a path, then times in rounds, each point next to
// the baseline.
#pragma once

#include <filesystem>
#include <functional>

#include "frontier/paired_times.h"
#include "frontier/points.h"
#include "frontier/record_file.h"
#include "plan/settings/model.h"
#include "run/scene_choice.h"

namespace lightgrid::lab {

// Two families of lights, instead of points and growth (families.h).
struct FamilyPlan {
  std::vector<int> lights = {100, 1000, 10'000, 100'000, 1'000'000};  // at an equal overlap, ascending
  double overlap = 10;
  std::vector<double> overlaps = {1, 3, 10, 30, 100, 300, 1000};  // at an equal number, ascending
  int number = 10'000;
  double max_frame_s = 2;  // points that take longer are refused, and not tried on more lights
};

struct FrontierJob {
  std::vector<ChosenPoint> points;
  ChosenPoint baseline;
  Settings common;
  FrontierTruth truth;
  int views = 16;        // at most: fewer if the time allows no more
  double seconds = 180;  // for the scene, from loading to its last record
  int min_rounds_per_point = min_rounds, max_rounds_per_point = 120;
  int controls = 3;  // the baseline as this many points of its own, in each round
  // For several processes that share the rounds: the first measures the figures, the last completes the
  // records.
  int process = 0, processes = 1;
  // Rounds end when half of each interval is at most this share of the relative time.
  double half_width = default_half_width;
  uint64_t seed = 1;
  // Pairs of pixel and light per view: those that the oracle shades, and those whose shadows it decides,
  // which takes longer (of more, an even sample of the pixels is taken).
  size_t shaded_pairs = 10'000'000, shadow_pairs = 1'000'000;
  bool sequences = false;   // SequenceErrors too, in time of their own: `seconds` are without them
  bool growth = true;       // the series of lights, pixels and radius too
  Kept keep = Kept::range;  // over the series of lights
  std::optional<FamilyPlan> families;
  std::filesystem::path pictures;  // folder; empty: no pictures
  std::filesystem::path exports;   // folder of what other renderers draw; used if one of the points runs
  // Called with the progress (0 to 1) and the next step.
  std::function<void(double done, const std::string& step)> progress;
  std::function<void(const std::string& what)> notice;
};

// The truth's lights have no ranges, and those of the settings have: pictures are compared with both.
inline bool has_authored(const FrontierJob& job) {
  return !job.truth.own_ranges && job.common[setting::range] != LightRange::infinite;
}

// Appends to `file` a record for each point and view, and for each point of a series. Points whose records
// are there are left out. Throws Error for what concerns the whole scene; a point that cannot run becomes a
// record with the reason.
// Returns the seconds that the sequences took.
double measure_scene(Renderer& renderer, const SceneChoice& choice, const FrontierJob& job, RecordFile& file);

// Writes scene.glb and views.json of the sweep's views into the folder (frontier/export.h), with the truths
// that pictures of other renderers are compared with: truth_N.exr and, where lights have ranges and the
// truth's have none, authored_N.exr. Throws as export_scene does.
void export_with_truths(Renderer& renderer, const SceneChoice& choice, const FrontierJob& job,
                        const std::filesystem::path& folder);

// The machine that a part is measured on.
FrontierMachine machine_of(const Renderer& renderer);
double load_average();  // mean of the last minute; 0: unknown

}  // namespace lightgrid::lab
