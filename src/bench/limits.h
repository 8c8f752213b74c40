// What the machine can do at best on its OpenCL device: the limits that kernels are held against.
#pragma once

#include "base/timer.h"
#include "cl/device.h"
#include "cl/launch.h"
#include "cl/program_cache.h"

namespace lightgrid {

// A plain read of a buffer by as many items as proved fastest. Sums are not looked at.
class PlainRead {
 public:
  PlainRead(ClDevice& device, ProgramCache& programs);

  // Tries numbers of items on this buffer and keeps the best; once for each size that is measured. Returns the least
  // time met, milliseconds on the device.
  double fit(const cl::Buffer& buffer, size_t bytes, int tries = 5);

  // Milliseconds on the device. `bytes` is rounded down to what the kernel reads, bytes_read().
  double run(const cl::Buffer& buffer, size_t bytes);
  static size_t bytes_read(size_t bytes) { return bytes / block_bytes * block_bytes; }

 private:
  static constexpr size_t block_bytes = 512;
  ClDevice& device_;
  cl::Kernel kernel_;
  cl::Buffer sums_;
  size_t items_ = 0, group_ = 1;
};

// Times in milliseconds, each over several runs. Rates follow from the least time, the machine at its best.
struct Limits {
  Spread read_large;    // on the device: a buffer far larger than caches; no runs where it was not asked for
  Spread read_depth;    // on the device: one as large as the depth of 1920 x 1080
  Spread copy;          // the same, to another of its size: counts what is read and what is written
  Spread flops;         // on the device
  Spread launch_wait;   // wall clock: an empty kernel and the wait for it
  Spread more_launch;   // wall clock: each further empty kernel before one wait
  Spread to_device, to_host;  // wall clock: depth_bytes over, with the wait
  size_t large_bytes = 0, depth_bytes = 0;
  double operations = 0;

  double read_gb_s() const { return 1e-6 * double(large_bytes) / read_large.min; }
  double read_depth_gb_s() const { return 1e-6 * double(depth_bytes) / read_depth.min; }
  double copy_gb_s() const { return 2e-6 * double(large_bytes) / copy.min; }
  double gflop_s() const { return 1e-6 * operations / flops.min; }
};

// The large buffers take a second or two: `with_large` asks for them.
Limits measure_limits(ClDevice& device, ProgramCache& programs, int runs, bool with_large);

}  // namespace lightgrid
