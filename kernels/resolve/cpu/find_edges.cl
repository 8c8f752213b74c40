// Pixels whose samples all see one surface, and those at edges, whose samples see more: a work-item takes
// EDGE_RUN pixels of the image, 16 at a time.
//
// triangles, depths  SAMPLES a pixel, side by side: a triangle number or SURFACE_NONE; reversed depth.
// Numbers
//                    of triangles that are one surface in a pixel become one
//                    (kernels/resolve/join_surfaces.h)
// triangle_instance, instances, indices, clip  what a triangle number leads to
// width, height      of the image, pixels
// pixel_triangles, pixel_depths  out: of pixels with one surface as of one sample at the centre; of others
//                    SURFACE_NONE and 0
// edges              out: a bit a pixel, 16 in a value, 1 at edges
#define LANES 16
#include "kernels/common/interleave.h"
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/resolve/join_surfaces.h"
#include "shared/real.h"

#define EDGE_RUN 4096u
#define KNOWN_PAIRS 1024u

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

// Returns whether two triangles are neighbours. A pair meets in several pixels: some answers are kept, as two
// numbers << 1 | the answer, since a triangle's corners are far away.
static inline bool known_neighbours(ulong* known, uint a, uint b, const SeenTriangles* scene) {
  const uint low = min(a, b), high = max(a, b);
  const ulong pair = ((ulong)low << 31 | high) << 1;  // numbers are below 2^31
  ulong* const place = known + (low * 5u + high) % KNOWN_PAIRS;
  if ((*place & ~1ul) != pair) {
    const SeenTriangle one = seen_triangle(scene, a), other = seen_triangle(scene, b);
    *place = pair | (are_neighbours(&one, &other) ? 1u : 0u);
  }
  return *place & 1u;
}

kernel ONE_ITEM void find_edges(global uint* triangles, global const float* depths,
                                global const uint* triangle_instance,
                                global const RasterInstanceRecord* instances, global const uint* indices,
                                global const float4* clip, uint width, uint height,
                                global uint* pixel_triangles, global float* pixel_depths,
                                global ushort* edges) {
  ASSUME_ONE_ITEM;
  const SeenTriangles scene = {triangle_instance, instances, indices, clip};
  const float2 half_size = (float2)(0.5f * (float)width, 0.5f * (float)height);
  const uint pixels = width * height;
  const uint begin = (uint)get_global_id(0) * EDGE_RUN, end = min(begin + EDGE_RUN, pixels);
  ulong known[KNOWN_PAIRS];
  for (uint i = 0; i < KNOWN_PAIRS; ++i) known[i] = ~0ul;
  for (uint at = begin; at < end; at += 16) {
    const uint count = min(end - at, 16u);
    uint16 seen[SAMPLES], depth_bits[SAMPLES];
    load_samples(triangles + (size_t)at * SAMPLES, count, seen);
    load_samples((global const uint*)depths + (size_t)at * SAMPLES, count, depth_bits);
    uint16 other = seen[0];  // the first sample's that sees another triangle than the first one
    real depth = as_float16(depth_bits[0]);
    whole with_first = 1;
#pragma unroll
    for (uint s = 1; s < SAMPLES; ++s) {
      other = seen[SAMPLES - s] != seen[0] ? seen[SAMPLES - s] : other;
      with_first -= seen[s] == seen[0];
      depth += as_float16(depth_bits[s]);
    }
    depth *= 1.0f / SAMPLES;
    mask_t edge = other != seen[0], more = 0;
#pragma unroll
    for (uint s = 1; s < SAMPLES; ++s) more |= (seen[s] != seen[0]) & (seen[s] != other);
    const uint covered = mask_bits((seen[0] != (uint16)(SURFACE_NONE)) & (other != (uint16)(SURFACE_NONE)));
    const uint of_more = mask_bits(more);
    uint16 triangle = with_first * 2 >= (whole)(SAMPLES) ? seen[0] : other;
    uint edge_bits = mask_bits(edge) & first_lanes(count);
    for (uint left = edge_bits & (covered | of_more); left != 0; left &= left - 1) {
      const uint i = lowest_bit(left);
      global uint* const of_pixel = triangles + (size_t)(at + i) * SAMPLES;
      global const float* const depths_here = depths + (size_t)(at + i) * SAMPLES;
      float* const depth_here = (float*)&depth + i;
      const uint x = (at + i) % width, y = (at + i) / width;
      if (of_more >> i & 1u) {
        if (!join_surfaces(of_pixel, &scene, x, y, half_size, depths_here, depth_here)) continue;
        ((uint*)&triangle)[i] = of_pixel[0];
      } else {
        const uint one = ((const uint*)&seen[0])[i], two = ((const uint*)&other)[i];
        if (!known_neighbours(known, one, two, &scene)) continue;
#ifdef SHADOWED
        const SeenTriangle a = seen_triangle(&scene, one), b = seen_triangle(&scene, two);
        const bool first = holds_centre(&a, &scene, x, y, half_size, depths_here, depth_here);
        if (!first && !holds_centre(&b, &scene, x, y, half_size, depths_here, depth_here)) continue;
        ((uint*)&triangle)[i] = first ? one : two;
#endif
        see_everywhere(of_pixel, ((const uint*)&triangle)[i]);
      }
      edge_bits &= ~(1u << i);
      ((int*)&edge)[i] = 0;
    }
    triangle = edge ? (uint16)(SURFACE_NONE) : triangle;
    depth = edge ? REAL(0.0f) : depth;
    if (count == 16) {
      vstore16(triangle, 0, pixel_triangles + at);
      vstore16(depth, 0, pixel_depths + at);
    } else {
      for (uint i = 0; i < count; ++i) {
        pixel_triangles[at + i] = ((const uint*)&triangle)[i];
        pixel_depths[at + i] = ((const float*)&depth)[i];
      }
    }
    edges[at / 16] = (ushort)edge_bits;
  }
}
