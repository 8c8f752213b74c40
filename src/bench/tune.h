// Tries the kernel shapes and sizes that a device may run, and tells which are fastest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cl/tuned_sizes.h"
#include "bench/standard_frames.h"

namespace lightgrid {

struct TuneOptions {
  int frames = 20, warmup = 2;
  std::function<void(double done, const std::string& what)> step;  // progress; may be empty
};

struct TuneTrial {
  std::string assignment;  // "kernel-shape=lanes"
  double ratio = 0;        // of the median times to those of the fastest value of the key: 1 or more
  std::string failure;     // why it does not run here; empty where it does
};

struct TuneResult {
  TunedSizes best;
  std::vector<TuneTrial> trials;
};

// One key after the other, each with the best of those before; a key's values run in turn on small and large standard
// frames, and the least geometric mean of their medians wins. Results are the same bytes whatever is chosen.
TuneResult tune_kernels(ClDevice& device, const TuneOptions& options);

}  // namespace lightgrid
