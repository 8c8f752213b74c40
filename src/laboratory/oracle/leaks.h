// Light that goes through walls: where lights that cast no shadow light what an opaque surface hides from
// them. By the oracle of shadows, in double; needs no device.
#pragma once

#include <string>

#include "scene/camera.h"
#include "scene/light_ranges.h"

namespace lightgrid::lab {

struct Leak {
  int light = 0, instance = 0;  // in the scene: the light, and one of the instances that hide it
  uint64_t pixels = 0;          // sampled ones, at which this is so
};

struct Leaks {
  uint64_t pixels = 0;  // sampled, with an opaque surface
  // Pairs of these and a light that casts no shadow, lights them, and is on the side of the surface that the
  // eye sees. Either: of these, pairs whose answer turns on rounding.
  uint64_t lit = 0, leaked = 0, either = 0;
  std::vector<Leak> leaks;  // most pixels first
  // The same pairs by light and by the instance that is lit; those that turn on rounding count as seen.
  struct Received {
    int light = 0, instance = 0;
    uint64_t seen = 0, leaked = 0;
  };
  std::vector<Received> received;
};

// About `samples` pixels, evenly spread. Deterministic.
Leaks find_leaks(const Scene& scene, const View& view, const LightRanges& ranges, int samples = 4096);

// As `lightgrid plan` prints them: the worst `most` in a line each.
std::string describe(const Leaks& leaks, const Scene& scene, size_t most);

}  // namespace lightgrid::lab
