// The shadows of one frame, for a look at its pixels.
#pragma once

#include <optional>

#include "reference/lit_set.h"
#include "session/shadow_truth.h"
#include "session/technique_run.h"

namespace lightgrid {

// What the surfaces of a frame, drawn once, meet between them and the lights that cast.
class FrameShadows {
 public:
  FrameShadows(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings,
               const Technique& technique);

  // light: in the scene, one that casts. None where the pixel shows no triangle.
  std::optional<SightAnswer> sight(int x, int y, size_t light);
  // Whether the frame shades the light as hidden. local: its index in lists.
  bool shaded_as_hidden(int x, int y, uint32_t local) const;
  // For count_pairs. All pairs are decided, or those of a sample of the pixels.
  PairShadows pairs();

 private:
  static constexpr uint64_t most_pairs = 10'000'000;

  TechniqueRun run_;
  ShadowTruth truth_;
  std::vector<float> depth_;
  std::vector<SceneTriangle> shown_;
  std::optional<HostShadows> shaded_;
};

}  // namespace lightgrid
