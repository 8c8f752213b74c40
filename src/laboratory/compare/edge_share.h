// Predicts samples in a view by the oracle's rays, without a device: pixels with edges, and the saving from
// shading the others once.
#pragma once

#include <string>

#include "scene/camera.h"

namespace lightgrid {

struct EdgeShare {
  int samples = 0;       // a pixel
  uint64_t pixels = 0;   // looked at
  uint64_t edges = 0;    // pixels of these whose samples see several surfaces or also the background
  uint64_t covered = 0;  // samples that see a surface
  uint64_t shaded = 0;   // surfaces, each once a pixel

  // The share of `covered` that need not be shaded.
  double saved() const { return covered > 0 ? 1 - double(shaded) / double(covered) : 0; }
};

// At about `most` pixels, evenly spread. samples: 2, 4 or 8. Deterministic.
EdgeShare find_edge_share(const Scene& scene, const View& view, int samples, size_t most = 4096);

// As `lightgrid plan` prints it.
std::string describe(const EdgeShare& share, const View& view);

}  // namespace lightgrid
