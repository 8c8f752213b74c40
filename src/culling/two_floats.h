// A number as the sum of two floats, for kernels without double.
#pragma once

namespace lightgrid {

struct TwoFloats {
  float value, rest;
};

// Never inlined: GCC 12.2 at -O2 vectorizes two of these side by side and then
// computes double(float(x)) as x, which makes the second floats 0 (docs/devices.md#known-faults).
[[gnu::noinline]] TwoFloats two_floats(double number);

}  // namespace lightgrid
