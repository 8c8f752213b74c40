// Builds only where the compiler has the AVX-512 builtins of kernels/common/pack.h
// and the CPU has the instructions.
#define LANES 16
#define AVX512
#include "kernels/common/pack.h"

kernel void probe_avx512(global float* out) {
  const float16 v = vload16(0, out);
  append_reals(out, v, mask_bits(v > (float16)(0.0f)));
}
