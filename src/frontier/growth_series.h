// How times grow with lights, pixels and the lights' ranges.
#pragma once

#include "frontier/measure.h"

namespace lightgrid {

// Of the techniques among the job's points, each as it is, beside the baseline: on scattered lights (128,
// 512, 2048), on sizes (half, whole, twice a side) and on ranges (half, whole, twice). Ends when `seconds`
// have passed. The scene is left as it was.
void measure_growth(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                    const FrontierJob& job, double seconds, RecordFile& file);

}  // namespace lightgrid
