// Angles of directions, the same bits on all devices: no atan or acos of a device.
#pragma once

#include "shared/real.h"

#define HALF_TURN 3.14159265f

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// 2 atan(t), for t from 0 to 1. The relative error is at most 3e-7.
SHARED_FUNCTION real twice_atan(real t) {
  real s = t * t;
  real p = mad_real(s, REAL(0.00276628346f), REAL(-0.015731249f));
  p = mad_real(s, p, REAL(0.0421376228f));
  p = mad_real(s, p, REAL(-0.0745685473f));
  p = mad_real(s, p, REAL(0.106183708f));
  p = mad_real(s, p, REAL(-0.141977981f));
  p = mad_real(s, p, REAL(0.199918717f));
  p = mad_real(s, p, REAL(-0.333330363f));
  p = mad_real(s, p, REAL(1.0f));
  return (t + t) * p;
}

// The angle, 0 to pi, of a direction with the components `along` and `across` (0 or more), whose length is
// `length`. By half the angle's tangent: well conditioned at all angles.
SHARED_FUNCTION real angle_from(real along, real across, real length) {
  real acute = twice_atan(across / max_real(length + max_real(along, -along), REAL(1e-30f)));
  return along < REAL(0.0f) ? REAL(HALF_TURN) - acute : acute;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
