// The shadows of one frame, for a look at its pixels.
#pragma once

#include <optional>

#include "accuracy/scene_occlusion.h"
#include "oracle/lit_set.h"
#include "oracle/seen_pairs.h"
#include "run/frames.h"

namespace lightgrid::lab {

// The surfaces that a frame shaded, copied from the devices, and the shadows that it shaded them with.
struct FrameShadows {
  View view{};
  std::vector<float> depth;
  std::vector<SceneTriangle> shown;                  // the nearest opaque one of each pixel
  std::optional<HostShadows> shaded;                 // none: every light is shaded
  BlendedCasters by_blended = BlendedCasters::none;  // the run's setting, which the oracle has too

  // This and the oracle outlive it.
  PixelShadows at(int x, int y, SceneOcclusion& occlusion) const;
};

// Reads the shadows of the run's last frame.
FrameShadows read_frame_shadows(TechniqueRun& run);

}  // namespace lightgrid::lab
