// Techniques while the camera moves: times, errors, flicker, and work that a moving camera should not cause.
#pragma once

#include <functional>
#include <memory>

#include "compare/compare.h"
#include "run/frames.h"

namespace lightgrid::lab {

// A camera path over a scene, which may move too.
struct MovingScene {
  GpuScene& gpu;  // shared by all runs
  std::vector<View> path;
  SceneMotion advance;  // empty: the scene rests
};

// Moves the runs along a path, interleaved frame by frame. Null runs are skipped. Afterwards `runs` and
// `reference` are at the path's last view, and so are their images. Errors are against the reference's image
// of the same frame, over all frames; pairs are summed. Sets RunResult::moving in `rows`, in the order of
// `runs`. progress: called before each frame.
PathMemory run_along_path(const std::vector<TechniqueRun*>& runs, TechniqueRun& reference,
                          const MovingScene& moving, std::vector<RunResult>& rows,
                          const std::function<void(double done)>& progress);

}  // namespace lightgrid::lab
