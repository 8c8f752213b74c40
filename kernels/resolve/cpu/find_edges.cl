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
#include "kernels/common/interleave.h"
#include "kernels/common/pack.h"
#include "kernels/resolve/join_surfaces.h"
#include "shared/real.h"

#define EDGE_RUN 4096u

// SAMPLES values of each of 16 pixels.
static inline void load_samples(global const uint* values, uint count, uint16* of) {
  if (count == 16) {
#pragma unroll
    for (uint i = 0; i < SAMPLES; ++i) of[i] = vload16(i, values);
  } else {
    for (uint i = 0; i < SAMPLES * 16; ++i) ((uint*)of)[i] = values[min(i, count * SAMPLES - 1)];
  }
  separate(of);
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
