// Compares several ways to do one thing, timed in turn.
#pragma once

#include <functional>
#include <vector>

#include "base/timer.h"
#include "bench/limits.h"
#include "bench/runs.h"

namespace lightgrid {

struct MeasuredRun {
  struct Kernel {
    std::string label;
    int launches = 0;  // in one run
    Spread ms;         // on the device, all of its launches in one run
  };
  Spread wall;                  // one wait at the end
  Spread device;                // the sum over all kernels of one run, which is timed by events; not the run
                                // of `wall`
  std::vector<Kernel> kernels;  // in order of first launch
  Spread lights_upload, grid_download;  // of culling: wall clock, each with its wait
  Spread overhead;                      // wall minus device, for the runs timed by events
};

struct MeasuredFrame {
  std::vector<MeasuredRun> runs;  // one for each contestant
  Spread plain_read;              // of the same depth buffer, in the same rounds
  double least_read_ms = 0;       // the least of those and of the earlier runs that fitted it
};

struct Rounds {
  int warmup = 3, timed = 30;
  std::function<void(double done)> progress;  // may be empty
};

// In each round each piece of work runs once for the wall clock and once for the device's. end_of_round is
// then called: whether the round counts. Each ends with a wait.
std::vector<MeasuredRun> time_in_turn(ClDevice& device, const std::vector<std::function<void()>>& work,
                                      const Rounds& rounds,
                                      const std::function<void(bool counts)>& end_of_round);

// The same of culling. In each round each contestant runs once for the wall clock and once for the device's,
// and the depth buffer is read once, so that other load on the machine affects all of them.
MeasuredFrame measure_in_turn(ClDevice& device, const std::vector<CullingRun*>& contestants, PlainRead& read,
                              const Rounds& rounds);

}  // namespace lightgrid
