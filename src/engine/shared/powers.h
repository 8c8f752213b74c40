// Logarithms and powers, the same bits on all devices: no exp or log of a device. Whole numbers handle the exponents,
// minimax polynomials the rest. Relative errors, by tests/engine/certify/powers.h for all floats, with u = 2^-24:
// logarithms 3.81 u, exp2_of 1.94 u, so that a power x^e has (3.4 |e log2 x| + 2) u.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// n of x = 2^n m, for x > 0 and m from sqrt(1/2) to sqrt(2).
SHARED_FUNCTION Whole nearest_exponent(real x) { return (bits_of_real(x) - WHOLE(0x3f3504f3)) >> WHOLE(23); }

// log2 of 2^n (1 + rest): log m = 2 artanh((m - 1) / (m + 1)).
SHARED_FUNCTION real log2_of_parts(Whole n, real rest) {
  real t = rest / (rest + 2.0f);
  real t2 = t * t;
  real series = mad_real(t2, mad_real(t2, 0.480099052f, 0.574598253f), 0.961821854f);
  series = mad_real(t2, series, 2.88539004f);
  return mad_real(series, t, real_of_whole(n));
}

// x: positive and normal.
SHARED_FUNCTION real log2_of(real x) {
  Whole n = nearest_exponent(x);
  return log2_of_parts(n, real_of_bits(bits_of_real(x) - (n << WHOLE(23))) - 1.0f);
}

// log2(1 - s) for s from 0 to 1; -100 for 1. Only n comes from the rounded 1 - s. The rest, 2^-n (1 - s) - 1, is exact.
SHARED_FUNCTION real log2_of_one_minus(real s) {
  Whole n = nearest_exponent(max_real(1.0f - s, REAL(7.8886091e-31f)));
  real scale = real_of_bits((WHOLE(127) - n) << WHOLE(23));
  EXACTLY real rest = (scale - 1.0f) - scale * s;
  return log2_of_parts(n, rest);
}

// 2^y for y up to 127; 0 below -126.
SHARED_FUNCTION real exp2_of(real y) {
  real inside = max_real(y, REAL(-126.0f));
  real nearest = floor_real(inside + 0.5f);
  real r = inside - nearest;
  real power = mad_real(r, mad_real(r, 0.000158694849f, 0.00134149357f), 0.00961704738f);
  power = mad_real(r, mad_real(r, power, 0.0555027202f), 0.240226552f);
  power = mad_real(r, mad_real(r, power, 0.693147242f), 1.0f);
  power = power * real_of_bits((whole_of_real(nearest) + WHOLE(127)) << WHOLE(23));
  return y < REAL(-126.0f) ? REAL(0.0f) : power;
}

// x: positive and normal; x^e: up to 2^127.
SHARED_FUNCTION real power_of(real x, real e) { return exp2_of(e * log2_of(x)); }

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
