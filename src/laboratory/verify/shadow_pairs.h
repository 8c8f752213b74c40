// The shadows of an image against the oracle, pair by pair.
#pragma once

#include "verify/engine.h"

namespace lightgrid::lab::verify {

// Pairs of a pixel and a light that casts, within its range and cone according to the oracle.
struct ShadowPairs {
  uint64_t seen = 0, hidden = 0;   // decided: which of the two (docs/oracle.md#seen-and-hidden)
  uint64_t either = 0;             // not decided
  uint64_t leaked = 0, acned = 0;  // decided pairs: hidden but not found so, and the other way round
  std::string why;                 // the first of these

  uint64_t decided() const { return seen + hidden; }
  uint64_t wrong() const { return leaked + acned; }
  ShadowPairs& operator+=(const ShadowPairs& more);
};

// On all cores. occlusion: of the scene. Throws Error(input) if the lists are no lists of lights that cast.
ShadowPairs count_shadow_pairs(const Scene& scene, const Occlusion& occlusion, const View& view,
                               const ShadowImage& image);
// For images that show the same surfaces and have the same lights: the oracle decides once.
std::vector<ShadowPairs> count_shadow_pairs(const Scene& scene, const Occlusion& occlusion, const View& view,
                                            const std::vector<const ShadowImage*>& images);
bool same_surfaces_and_lights(const ShadowImage& a, const ShadowImage& b);

// Empty, or in which of surfaces, lists and bits two images differ.
const char* difference(const ShadowImage& a, const ShadowImage& b);

}  // namespace lightgrid::lab::verify
