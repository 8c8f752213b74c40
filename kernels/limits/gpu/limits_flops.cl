// What arithmetic alone takes, for GPUs: as limits/cpu/limits_flops.cl, with scalar chains and many items.
#define CHAINS 12

kernel void limits_flops(float factor, float term, uint steps, global float* results) {
  float x[CHAINS];
#pragma unroll
  for (int i = 0; i < CHAINS; ++i) x[i] = factor * (float)i + (float)get_global_id(0);
  for (uint s = 0; s < steps; ++s) {
#pragma unroll
    for (int i = 0; i < CHAINS; ++i) x[i] = x[i] * factor + term;
  }
  float sum = 0.0f;
#pragma unroll
  for (int i = 0; i < CHAINS; ++i) sum += x[i];
  results[get_global_id(0)] = sum;
}
