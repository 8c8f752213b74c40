// Between 16 values of each of SAMPLES samples and the SAMPLES values of each of 16 pixels, side by side.
#pragma once

#include "kernels/common/sample_places.h"

#define IN_TURN(a, b) \
  (uint16)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7)

// In: v[s] has sample s, a lane a pixel. Out: pixel after pixel, its samples side by side.
static inline void interleave(uint16* v) {
#pragma unroll
  for (int step = 1; step < SAMPLES; step *= 2) {
    uint16 from[SAMPLES];
#pragma unroll
    for (int i = 0; i < SAMPLES; ++i) from[i] = v[i];
#pragma unroll
    for (int i = 0; i < SAMPLES / 2; ++i) {
      v[2 * i] = IN_TURN(from[i].lo, from[i + SAMPLES / 2].lo);
      v[2 * i + 1] = IN_TURN(from[i].hi, from[i + SAMPLES / 2].hi);
    }
  }
}

// The way back.
static inline void separate(uint16* v) {
#pragma unroll
  for (int step = 1; step < SAMPLES; step *= 2) {
    uint16 from[SAMPLES];
#pragma unroll
    for (int i = 0; i < SAMPLES; ++i) from[i] = v[i];
#pragma unroll
    for (int i = 0; i < SAMPLES / 2; ++i) {
      v[i] = (uint16)(from[2 * i].even, from[2 * i + 1].even);
      v[i + SAMPLES / 2] = (uint16)(from[2 * i].odd, from[2 * i + 1].odd);
    }
  }
}
