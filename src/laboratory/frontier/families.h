// Two families of scattered lights that turn one knob each: their number at an equal overlap, and the overlap
// at an equal number. Overlap: how many lights reach a pixel in the mean.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "frontier/measure.h"

namespace lightgrid::lab {

// Lights that reach a covered pixel (depth > 0) in the mean, with their own ranges, by the oracle's test in
// double. depth: width * height, row 0 at the bottom. 0 where nothing is covered.
double overlap_of(const Scene& scene, const View& view, const std::vector<float>& depth);

// How far an overlap may be from what a family asks for, as a share of it.
inline constexpr double overlap_tolerance = 0.01;

// The scale at which `overlap_at`, which grows with it, is `overlap` within the tolerance. None if it does
// not come so far.
std::optional<double> scale_of_overlap(double overlap, const std::function<double(double scale)>& overlap_at);

// For each variant of both families (job.families) and each of the job's points, a record with figures and
// times, until job.seconds have passed. One view: the scene's first camera's, or the chosen one. Lights are
// scattered anew (scatter_lights). At an equal overlap ranges are scaled, and intensities with their squares,
// so that the picture is as bright; at an equal number ranges alone, so that the picture without ranges stays
// the same. Errors are of the whole picture, against every light without a range and against authored ranges;
// the others are NaN. Both truths are drawn by visibility, for all points. The scene is left as it was.
void measure_families(Renderer& renderer, Scene& scene, const SceneChoice& choice, const FrontierJob& job,
                      RecordFile& file);

}  // namespace lightgrid::lab
