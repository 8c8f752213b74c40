// A number as the sum of two floats, for kernels without double.
#pragma once

namespace lightgrid {

struct TwoFloats {
  float value, rest;
};

// A function of its own, never inlined: GCC 12.2 at -O2 vectorizes two of these side by side, and there takes
// double(float(x)) for x, so that the rests are 0 (docs/devices.md#known-faults).
TwoFloats two_floats(double number);

}  // namespace lightgrid
