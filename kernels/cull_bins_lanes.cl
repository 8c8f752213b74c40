// Coarse step of light culling, for CPUs: which lights may touch each bin of BIN_TILES x BIN_TILES tiles. One
// work-item walks all lights for one bin, LANES at a time.
//
// spheres     structure of arrays x, y, d, radius of light_stride floats each, view space, d = -z; readable up to a
//             multiple of LANES
// cones       float4 a light: unit axis (d = -z), and the outer half-angle's cosine; w > 1.5 where it has none
// intervals   float2 a tile: least and greatest distance (depth_bounds)
// bins        uint2 a bin: .y = number of candidates (-DCOUNT writes it); .x = first candidate (read by the fill step)
// candidates  (fill) x, y, d, inflated radius of candidate_stride floats each, then light indices; in the lights' order
//
// -DCOUNT counts, else fills; both run the same test. -DSPOTS: some light has a cone. A bin whose candidates would
// pass candidate_stride writes none of them; the host sees the total and runs the step again with more room.
#include "kernels/common/bin.h"

kernel void cull_bins_lanes(global const float* spheres, uint light_stride, global const float4* cones,
                            global const float2* intervals, global uint2* bins, global float* candidates,
                            uint candidate_stride, constant ViewParams* view) {
  const uint bin = get_global_id(0);
  const Cell cell = bin_cell(bin, intervals, view);
  uint n = 0;
#ifndef COUNT
  const uint first = bins[bin].x;
  if ((ulong)first + bins[bin].y > candidate_stride) return;
#endif
  if (cell.near <= cell.far) {
    for (uint i = 0; i < view->light_count; i += LANES) {
      const real x = LOAD(spheres + i), y = LOAD(spheres + light_stride + i);
      const real d = LOAD(spheres + 2 * (size_t)light_stride + i);
      const real r = inflated(x, y, d, LOAD(spheres + 3 * (size_t)light_stride + i));
      uint bits = mask_bits(sphere_may_touch(x, y, d, r, &cell));
      if (view->light_count - i < LANES) bits &= (1u << (view->light_count - i)) - 1u;
#ifdef SPOTS
      bits = drop_cones(bits, i, spheres, light_stride, cones, &cell);
#endif
#ifdef COUNT
      n += popcount(bits);
#else
      for (; bits; bits &= bits - 1, ++n) {
        const uint light = i + lowest_bit(bits);
        put_candidate(candidates, candidate_stride, first + n, spheres, light_stride, light);
      }
#endif
    }
  }
#ifdef COUNT
  bins[bin].y = n;
#endif
}
