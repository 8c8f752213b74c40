// The surfaces of one pixel at an edge, one after the other, for GPUs: as kernels/resolve/edge_surfaces.h has
// them, to the bit.
#pragma once

#include "kernels/resolve/resolve.h"
#include "kernels/resolve/samples.h"
#include "kernels/resolve/stored_batch.h"

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
