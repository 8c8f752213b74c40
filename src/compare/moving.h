// Techniques while the camera moves: times, errors, flicker, and the work that a moving camera should not cause.
#pragma once

#include <functional>
#include <memory>

#include "compare/compare.h"
#include "compare/run_technique.h"

namespace lightgrid {

// Moves the runs along a path, interleaved frame by frame. A null run is passed over. Afterwards `runs` and `reference` are at
// the path's last view, and their images are of it. `advance` (may be empty) moves the scene to a frame and says what changed;
// `gpu` is the GPU scene of all runs. Errors are against the reference's image of the same frame, over all frames; pairs are
// summed. `rows` get RunResult::moving, in the order of `runs`.
struct MovingScene {
  GpuScene& gpu;
  std::vector<View> path;
  SceneMotion advance;
};
void run_along_path(const std::vector<TechniqueRun*>& runs, TechniqueRun& reference, const MovingScene& moving,
                    std::vector<RunResult>& rows, const std::function<void(double done)>& progress);

}  // namespace lightgrid
