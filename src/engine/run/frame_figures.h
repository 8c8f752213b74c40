// Times, memory and work of a run's frames. measures/results.h adds their errors.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/timer.h"

namespace lightgrid {

struct KernelResult {
  std::string name;  // name of a kernel or a transfer
  double median_ms = 0;
};

struct PassResult {
  std::string name;
  std::string on;  // "gl", "cl" or "cpu"
  double median_ms = 0;
  size_t bytes_read = 0, bytes_written = 0;  // counted from the pass's inputs and outputs, not measured
  std::vector<KernelResult> kernels = {};    // kernels of OpenCL passes, by the device's own clock
};

struct SkippedEffect {
  std::string effect, why;
};

// The work for shadows in the last frame, and the lights that cast but needed none.
struct ShadowResult {
  struct Skipped {
    int light = 0;  // number in the scene
    std::string why;
  };
  size_t lights = 0;                                                         // whose shadows were found
  size_t maps = 0, drawn = 0, kept = 0, bytes = 0, rays = 0, undecided = 0;  // as in ShadowFigures
  std::vector<Skipped> skipped;
  size_t bands = 0;       // as in ShadowFigures
  double dim_steps = 0;   // as in FramePlan
  int halvings = 0;       // halvings of all maps' sizes
  size_t tiles_kept = 0;  // as in ShadowFigures
};

// The last frame with several samples per pixel: as SampleFigures.
struct SampleResult {
  size_t edge_pixels = 0, shadings = 0, covered = 0, bytes = 0;
};

struct FrameFigures {
  std::string technique;
  std::map<std::string, std::string> settings;
  int lights_total = 0, lights_in_view = 0;
  int lights_virtual = 0;  // included in lights_total
  Spread frame_ms;
  // The same frames in their order: wall-clock time, and processor time of this process.
  std::vector<double> wall_ms, cpu_ms;
  std::vector<PassResult> passes;
  size_t memory_total = 0, memory_light_grid = 0, memory_gbuffer = 0;
  std::string built_by;                      // as in Frame
  std::map<std::string, double> built_with;  // the same
  uint64_t nan_pixels = 0, inf_pixels = 0;
  std::vector<SkippedEffect> skipped;
  std::optional<ShadowResult> shadows;                           // absent if no light casts a shadow
  std::optional<SampleResult> samples;                           // absent with one sample per pixel
  std::map<std::string, std::map<std::string, double>> effects;  // figures of each, by its name
};

}  // namespace lightgrid
