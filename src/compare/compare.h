// Techniques side by side on one view, held against the brute-force image and the double-precision oracle.
#pragma once

#include <functional>

#include "results/results.h"
#include "techniques/technique.h"

namespace lightgrid {

struct Contestant {
  const Technique* technique;
  Settings settings;
};

// At which pixels every light is shaded. automatic: all, or a sample where this is estimated to take too long.
enum class ReferencePixels { automatic, full, sampled };

// Moves a scene to frame n of a path, counted from 0, and says what changed.
using SceneMotion = std::function<SceneChanges(size_t frame)>;

struct CompareOptions {
  int frames = 5, warmup = 1;
  size_t shaded_samples = 20000;  // pixels at which the oracle shades, for the model and precision errors
  ReferencePixels reference = ReferencePixels::automatic;
  uint64_t seed = 1;              // of the reference's sample
  double most_reference_ms = 60e3;  // what all of the reference's frames may take before automatic takes a sample
  std::vector<View> path;         // further frames with a camera that moves: RunResult::moving
  SceneMotion advance;            // of that path; empty: a scene at rest
  bool all_may_refuse = false;    // a report of refusals alone, instead of the first reason thrown
  // Told of each finished step: how far (0 to 1) and what comes next.
  std::function<void(double done, const std::string& step)> progress;
  // Told in one sentence where the reference is a sample because all pixels would take too long.
  std::function<void(const std::string& what)> notice;
};

// Runs the contestants interleaved, frame by frame. The reference is `forward`, run in addition where it is not
// among them. Error is against its image; pairs are counted on opaque surfaces, by reference/lit_set.h. A contestant
// that throws Error, or that memory does not hold, becomes a row that is `refused`, also where only its lists cannot be
// read out; the first reason is thrown where no contestant renders, unless all_may_refuse. Where the reference is a
// sample, contestants of its technique are refused, since a frame of theirs is what takes too long; errors are then over
// the sample's pixels. What the reference itself throws is thrown.
CompareReport compare_techniques(Renderer& renderer, const Scene& scene, const View& view,
                                 const std::vector<Contestant>& contestants, const CompareOptions& options);

}  // namespace lightgrid
