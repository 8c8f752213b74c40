// Techniques while the camera moves: times, errors, flicker, and the work that a moving camera should not cause.
#pragma once

#include <functional>
#include <memory>

#include "compare/compare.h"
#include "compare/run_technique.h"

namespace lightgrid {

// A camera path over a scene, which may move too.
struct MovingScene {
  GpuScene& gpu;           // of all runs
  std::vector<View> path;
  SceneMotion advance;     // empty: the scene rests
};

// Moves the runs along a path, interleaved frame by frame. A null run is passed over. Afterwards `runs` and `reference` are at
// the path's last view, and their images are of it. Errors are against the reference's image of the same frame, over all
// frames; pairs are summed. `rows` get RunResult::moving, in the order of `runs`.
void run_along_path(const std::vector<TechniqueRun*>& runs, TechniqueRun& reference, const MovingScene& moving,
                    std::vector<RunResult>& rows, const std::function<void(double done)>& progress);

}  // namespace lightgrid
