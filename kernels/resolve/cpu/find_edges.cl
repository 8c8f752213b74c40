// Pixels whose samples all see one surface, and those at edges, whose samples see more: a work-item takes
// EDGE_RUN pixels of the image, 16 at a time.
//
// triangles, depths  SAMPLES a pixel, side by side: a triangle number or SURFACE_NONE; reversed depth.
// Numbers
//                    of triangles that are one surface in a pixel become one
//                    (kernels/resolve/join_surfaces.h)
// triangle_instance, instances, indices, clip  what a triangle number leads to
// pixels             of the image
// pixel_triangles, pixel_depths  out: of pixels with one surface as of one sample at the centre; of others
//                    SURFACE_NONE and 0
// edges              out: a bit a pixel, 16 in a value, 1 at edges
#define LANES 16
#include "kernels/common/pack.h"
#include "kernels/resolve/join_surfaces.h"
#include "shared/real.h"

#define EDGE_RUN 4096u

#define HALF(v, i) (uint16)(v[i].even, v[i + 1].even)
#define OTHER_HALF(v, i) (uint16)(v[i].odd, v[i + 1].odd)

// From SAMPLES values of each of 16 pixels to 16 values of each sample.
static inline void by_sample(const uint16* v, uint16* of) {
#if SAMPLES == 2
  of[0] = HALF(v, 0), of[1] = OTHER_HALF(v, 0);
#else
  uint16 evens[SAMPLES];  // of even samples, then of odd ones
  for (uint i = 0; i < SAMPLES / 2; ++i)
    evens[i] = HALF(v, 2 * i), evens[SAMPLES / 2 + i] = OTHER_HALF(v, 2 * i);
#if SAMPLES == 4
  of[0] = HALF(evens, 0), of[2] = OTHER_HALF(evens, 0);
  of[1] = HALF(evens, 2), of[3] = OTHER_HALF(evens, 2);
#else
  uint16 fourths[SAMPLES];  // of samples 0 and 4, 2 and 6, 1 and 5, 3 and 7
  for (uint part = 0; part < 2; ++part) {
    for (uint i = 0; i < 2; ++i) {
      fourths[4 * part + i] = HALF(evens, 4 * part + 2 * i);
      fourths[4 * part + 2 + i] = OTHER_HALF(evens, 4 * part + 2 * i);
    }
  }
  of[0] = HALF(fourths, 0), of[4] = OTHER_HALF(fourths, 0);
  of[2] = HALF(fourths, 2), of[6] = OTHER_HALF(fourths, 2);
  of[1] = HALF(fourths, 4), of[5] = OTHER_HALF(fourths, 4);
  of[3] = HALF(fourths, 6), of[7] = OTHER_HALF(fourths, 6);
#endif
#endif
}

static inline void load_samples(global const uint* values, uint count, uint16* of) {
  uint16 v[SAMPLES];
  if (count == 16) {
#pragma unroll
    for (uint i = 0; i < SAMPLES; ++i) v[i] = vload16(i, values);
  } else {
    for (uint i = 0; i < SAMPLES * 16; ++i) ((uint*)v)[i] = values[min(i, count * SAMPLES - 1)];
  }
  by_sample(v, of);
}

kernel void find_edges(global uint* triangles, global const float* depths,
                       global const uint* triangle_instance, global const RasterInstanceRecord* instances,
                       global const uint* indices, global const float4* clip, uint pixels,
                       global uint* pixel_triangles, global float* pixel_depths, global ushort* edges) {
  const SeenTriangles scene = {triangle_instance, instances, indices, clip};
  const uint begin = (uint)get_global_id(0) * EDGE_RUN, end = min(begin + EDGE_RUN, pixels);
  for (uint at = begin; at < end; at += 16) {
    const uint count = min(end - at, 16u);
    uint16 seen[SAMPLES], depth_bits[SAMPLES];
    load_samples(triangles + (size_t)at * SAMPLES, count, seen);
    load_samples((global const uint*)depths + (size_t)at * SAMPLES, count, depth_bits);
    mask_t edge = 0;
    real depth = as_float16(depth_bits[0]);
#pragma unroll
    for (uint s = 1; s < SAMPLES; ++s) {
      edge |= seen[s] != seen[0];
      depth += as_float16(depth_bits[s]);
    }
    depth *= 1.0f / SAMPLES;
    uint16 triangle = seen[0];
    uint edge_bits = mask_bits(edge) & ((1u << count) - 1u);
    for (uint left = edge_bits; left != 0; left &= left - 1) {
      const uint i = lowest_bit(left);
      global uint* const of_pixel = triangles + (size_t)(at + i) * SAMPLES;
      if (!join_surfaces(of_pixel, &scene)) continue;
      edge_bits &= ~(1u << i);
      ((int*)&edge)[i] = 0, ((uint*)&triangle)[i] = of_pixel[0];
    }
    triangle = edge ? (uint16)(SURFACE_NONE) : triangle;
    depth = edge ? REAL(0.0f) : depth;
    if (count == 16) {
      vstore16(triangle, 0, pixel_triangles + at);
      vstore16(depth, 0, pixel_depths + at);
    } else {
      for (uint i = 0; i < count; ++i)
        pixel_triangles[at + i] = ((const uint*)&triangle)[i],
                             pixel_depths[at + i] = ((const float*)&depth)[i];
    }
    edges[at / 16] = (ushort)edge_bits;
  }
}
