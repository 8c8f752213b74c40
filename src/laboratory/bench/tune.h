// Finds the fastest kernel shape and sizes of a device.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/standard_frames.h"
#include "cl/tuned_sizes.h"

namespace lightgrid::lab {

struct TuneOptions {
  int frames = 20, warmup = 2;
  std::function<void(double done, const std::string& what)> step;  // progress; may be empty
};

struct TuneTrial {
  std::string assignment;  // "kernel-shape=lanes"
  double ratio = 0;        // median times relative to the fastest value of the key: 1 or more
  std::string failure;     // why it does not run here; empty if it does
};

struct TuneResult {
  TunedSizes best;
  std::vector<TuneTrial> trials;
};

// Tunes one key after the other, each with the best values of the previous ones. A key's values run in turn
// on small and large standard frames; the least geometric mean of their medians wins. All choices give the
// same bytes.
TuneResult tune_kernels(ClDevice& device, const TuneOptions& options);

}  // namespace lightgrid::lab
