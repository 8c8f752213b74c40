// Techniques side by side on one view, compared with the brute-force image and with the oracle.
#pragma once

#include <functional>

#include "measures/results.h"
#include "run/frames.h"
#include "scene/scene_motion.h"

namespace lightgrid::lab {

struct Contestant {
  const Technique* technique;
  Settings settings;
};

// The pixels of the reference. automatic: all, or a sample if all are estimated to take too long.
enum class ReferencePixels { automatic, full, sampled };

struct CompareOptions {
  int frames = 5, warmup = 1;
  size_t shaded_samples = 20000;  // pixels at which the oracle shades, for the model and precision errors
  ReferencePixels reference = ReferencePixels::automatic;
  uint64_t seed = 1;               // seed of the reference's sample
  double max_reference_ms = 60e3;  // limit for all of the reference's frames; beyond it, automatic takes a
                                   // sample
  std::vector<View> path;          // further frames with a moving camera: RunResult::moving
  SceneMotion advance;             // motion of the scene along that path; empty: at rest
  bool flip = false;  // HDR-FLIP of each image (measures/flip.h), unless the reference is a sample
  std::function<Exposure(const Image& reference)> exposure;  // exposure of pictures as displayed; empty: none
  bool all_may_refuse = false;  // if all contestants are refused, report that instead of throwing
  // Called after each step with the progress (0 to 1) and the next step's name.
  std::function<void(double done, const std::string& step)> progress;
  // Called with one sentence if the reference is a sample.
  std::function<void(const std::string& what)> notice;
};

// Runs the contestants interleaved, frame by frame. The reference is `forward`, or without OpenGL
// `visibility:lights=all`, run in addition if it is not among them. Errors are against its image, and
// those of light on surfaces drawn in OpenCL also against one frame of `visibility:lights=all`; pairs are
// counted on opaque surfaces, by oracle/lit_set.h. A contestant that throws Error, or runs out of memory,
// becomes a row with `refused`, even if only reading its lists fails. If no contestant renders, the first
// reason is thrown, unless all_may_refuse. If the reference is a sample (which needs OpenGL), contestants
// with its technique are refused, because their frames would take too long; errors are then over the sample's
// pixels. Exceptions of the reference itself are passed on.
CompareReport compare_techniques(Renderer& renderer, const Scene& scene, const View& view,
                                 const std::vector<Contestant>& contestants, const CompareOptions& options);

}  // namespace lightgrid::lab
