// Times: the limits of the machine's OpenCL device, with which kernels are compared, and several ways to do
// one thing, timed in turn.
#pragma once

#include <functional>
#include <vector>

#include "base/timer.h"
#include "bench/runs.h"
#include "cl/device.h"
#include "cl/launch.h"
#include "cl/program_cache.h"

namespace lightgrid::lab {

// The spread of the milliseconds that `run` returns, after two runs that are not counted.
Spread repeat(int runs, const std::function<double()>& run);
// The same of the wall-clock time that `work` takes.
Spread time_alone(int runs, const std::function<void()>& work);

// A plain read of a buffer by the fastest number of items found. Sums are discarded.
class PlainRead {
 public:
  PlainRead(ClDevice& device, ProgramCache& programs);

  // Tries numbers of items on this buffer and keeps the best; call once for each measured size. Returns the
  // least time, milliseconds on the device.
  double fit(const cl::Buffer& buffer, size_t bytes, int tries = 5);

  // Milliseconds on the device. `bytes` is rounded down to the kernel's granularity: bytes_read().
  double run(const cl::Buffer& buffer, size_t bytes);
  static size_t bytes_read(size_t bytes) { return bytes / block_bytes * block_bytes; }

 private:
  static constexpr size_t block_bytes = 512;
  ClDevice& device_;
  cl::Kernel kernel_;
  cl::Buffer sums_;
  size_t items_ = 0, group_ = 1;
};

// Times in milliseconds, each over several runs. Rates are computed from the least time.
struct Limits {
  Spread read_large;          // on the device: a buffer far larger than caches; no runs if not requested
  Spread read_depth;          // on the device: a buffer of the size of depth at 1920 x 1080
  Spread copy;                // the same, to another buffer of that size: counts bytes read and written
  Spread flops;               // on the device
  Spread launch_wait;         // wall clock: an empty kernel and the wait for it
  Spread more_launch;         // wall clock: each additional empty kernel before one wait
  Spread to_device, to_host;  // wall clock: transfer of depth_bytes, with the wait
  size_t large_bytes = 0, depth_bytes = 0;
  double operations = 0;

  double read_depth_gb_s() const { return 1e-6 * double(depth_bytes) / read_depth.min; }
  double gflop_s() const { return 1e-6 * operations / flops.min; }
};

// `with_large` measures the large buffers as well, which takes a second or two.
Limits measure_limits(ClDevice& device, ProgramCache& programs, int runs, bool with_large);

struct MeasuredRun {
  struct Kernel {
    std::string label;
    int launches = 0;  // in one run
    Spread ms;         // on the device, all of its launches in one run
  };
  Spread wall;                          // one wait at the end
  std::vector<double> wall_ms, cpu_ms;  // of the same runs, round by round; processor time of this process
  Spread device;                // the sum over all kernels of one run, which is timed by events; not the run
                                // of `wall`
  std::vector<Kernel> kernels;  // in order of first launch
  Spread lights_upload, grid_download;  // for culling: wall-clock time, each with its wait
  Spread overhead;                      // wall minus device, for the runs timed by events
};

struct MeasuredFrame {
  std::vector<MeasuredRun> runs;  // one for each contestant
  Spread plain_read;              // time for the same depth buffer, in the same rounds
  double min_read_ms = 0;         // the least of those and of the earlier runs that fitted it
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
MeasuredFrame measure_in_turn(ClDevice& device, ProgramCache& programs,
                              const std::vector<std::unique_ptr<CullingRun>>& contestants,
                              const Rounds& rounds);

}  // namespace lightgrid::lab
