// Runs a captured frame on the engines: compares the library's bytes with the float twin's, and the lists
// with the oracle.
#pragma once

#include <functional>

#include "capture/frame_file.h"
#include "verify/engine.h"
#include "verify/run.h"

namespace lightgrid::verify {

struct ReplayOptions {
  // Further views. The frame's view without slices and z-bins is always replayed.
  std::vector<CullView> more_views;
  bool every_combination = false;  // of cull test and depth bounds; else each test with the default bounds,
                                   // and each kind of bounds with the default test
  std::function<void(double done, const std::string& step)> progress;
};

// One case a device. Under the chosen settings, which include every cull test and every kind of depth bounds,
// on each view:
// - bounds and lists have the float twin's bytes in both kernel shapes (float_twin.h; the library only);
// - no pixel loses a light that the oracle in double (reference/lit_set.h) says is lit there. `lost` of the
//   outcome counts such (pixel, light) pairs, over all settings; one lost pair fails the case.
VerifyReport replay_frame(const std::vector<std::unique_ptr<CullEngine>>& engines, const CapturedFrame& frame,
                          const ReplayOptions& options = {});

// The frame's view with the slices and z-bins of its own grid, if the folder has one with any; and with those
// that `set` (KEY=VALUE: slices, z-bins, slice-spacing) selects. Throws Error(input) for any other key.
std::vector<CullView> replayed_views(const CapturedFrame& frame, const std::optional<FrameGrid>& own,
                                     const std::vector<std::string>& set);

}  // namespace lightgrid::verify
