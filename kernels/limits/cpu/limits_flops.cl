// Measures the time of arithmetic alone: each item runs CHAINS independent chains of x = x * a + b,
// `steps` long, on vectors of 16. A product and a sum are two operations: contraction is off, as
// in every kernel here. For CPUs.
#include "kernels/common/one_item.h"
#define CHAINS 12

kernel ONE_ITEM void limits_flops(float factor, float term, uint steps, global float* results) {
  ASSUME_ONE_ITEM;
  const float16 a = factor, b = term;
  float16 x[CHAINS];
  for (int i = 0; i < CHAINS; ++i) x[i] = (float16)(factor * (float)i + (float)get_global_id(0));
  for (uint s = 0; s < steps; ++s) {
#pragma unroll
    for (int i = 0; i < CHAINS; ++i) x[i] = x[i] * a + b;
  }
  float16 sum = 0.0f;
  for (int i = 0; i < CHAINS; ++i) sum += x[i];
  results[get_global_id(0)] = sum.s0 + sum.s5 + sum.sf;
}
