// The surfaces of one pixel at an edge, one after the other, for GPUs: as kernels/resolve/edge_surfaces.h has
// them, to the bit.
#pragma once

#include "kernels/resolve/resolve.h"
#include "kernels/resolve/samples.h"
#include "kernels/resolve/stored_batch.h"

// One surface of a pixel.
typedef struct PixelSurface {
  uint triangle;       // or SURFACE_NONE
  uint samples;        // that see it, a bit each
  float off_x, off_y;  // from the pixel's centre to the centroid, pixels
  float depth;
} PixelSurface;

// The next surface of a pixel, of the samples in `left`, a bit each, from which those that see it are taken.
static inline PixelSurface next_surface(global const uint* triangles, global const float* depths,
                                        uint* left) {
  PixelSurface p = {triangles[lowest_bit(*left)], 0, 0.0f, 0.0f, 0.0f};
  int x = 0, y = 0;
  // Without branches, which would be taken at random.
#pragma unroll
  for (uint s = 0; s < SAMPLES; ++s) {
    const bool here = triangles[s] == p.triangle;
    p.samples |= here ? 1u << s : 0u;
    x += here ? SAMPLE_UNITS_X(s) : 0;
    y += here ? SAMPLE_UNITS_Y(s) : 0;
    p.depth += here ? depths[s] : 0.0f;
  }
  *left &= ~p.samples;
  const int count = (int)popcount(p.samples);
  const float mean = 1.0f / (float)count;
  p.depth *= mean;
  p.off_x = (float)x * (mean / 256);
  p.off_y = (float)y * (mean / 256);
  return p;
}

// The samples of a pixel that see no surface, a bit each.
static inline uint missed_samples(global const uint* triangles, uint at) {
  uint missed = 0;
  for (uint s = 0; s < SAMPLES; ++s)
    missed |= triangles[(size_t)at * SAMPLES + s] == SURFACE_NONE ? 1u << s : 0u;
  return missed;
}

typedef struct ResolvedSurface {
  uint triangle, samples;  // that see it, a bit each
  float x, y, depth;       // place in pixels; reversed depth
  Attributes attributes;
  Surface material;
} ResolvedSurface;

// left: samples whose surfaces were not yet taken.
static inline ResolvedSurface next_resolved(global const uint* triangles, global const float* depths, uint at,
                                            uint* left, uint x, uint y, const ResolveScene* scene) {
  const PixelSurface p = next_surface(triangles + (size_t)at * SAMPLES, depths + (size_t)at * SAMPLES, left);
  const uint base_x = x & ~(EDGE_BLOCK - 1u), base_y = y & ~(EDGE_BLOCK - 1u);
  const float dx = (float)(x - base_x) + p.off_x, dy = (float)(y - base_y) + p.off_y;
  ResolvedSurface r = {p.triangle, p.samples, (float)base_x + 0.5f + dx, (float)base_y + 0.5f + dy, p.depth};
  add_triangle(&r.attributes, scene, p.triangle, 1, (float)base_x, (float)base_y, dx, dy);
  add_material(&r.material, &r.attributes, scene, (uint)r.attributes.material, 1);
  return r;
}
