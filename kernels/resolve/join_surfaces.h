// Triangles that one pixel's samples see and that are one surface: triangles of an instance that share an
// edge and turn the same way on the screen. Attributes and positions go on across a shared edge, and such
// triangles lie on opposite sides of it in the image, so that none hides the other within the pixel. A
// silhouette, a crease or a seam whose corners have vertices of their own, and another instance, stay apart.
//
// All samples of such a surface get the number of its triangle that most of them see, the first of equals.
//
// -DSHADOWED  some light casts. A shadow is found at a point of one triangle: beside it, in a hollow, the
// triangle's plane is behind its neighbours, which would hide the light. Triangles are then one surface only
// if they are all that the pixel's samples see, and one of them holds the pixel's centre: samples get its
// number, and the pixel its depth.
#pragma once

#include "kernels/resolve/samples.h"
#include "kernels/common/surface_attributes.h"
#include "shared/raster_instance.h"

// The rasteriser's data by triangle number.
typedef struct SeenTriangles {
  global const uint* triangle_instance;
  global const RasterInstanceRecord* instances;
  global const uint* indices;
  global const float4* clip;
} SeenTriangles;

typedef struct SeenTriangle {
  uint number, samples;  // samples: that see it, a bit each
  uint instance, a, b, c;
  bool turns_left;  // counter-clockwise on the screen; told of two-sided ones
} SeenTriangle;

static inline SeenTriangle seen_triangle(const SeenTriangles* s, uint number) {
  SeenTriangle t = {number, 0, SURFACE_NONE, 0, 0, 0, false};
  if (number == SURFACE_NONE) return t;
  t.instance = s->triangle_instance[number];
  global const RasterInstanceRecord* r = s->instances + t.instance;
  global const uint* index = s->indices + r->first_index + 3 * (size_t)(number - r->first_triangle);
  t.a = index[0];
  t.b = index[1];
  t.c = index[2];
  if (r->flags & RASTER_TWO_SIDED) {
    global const float4* clip = s->clip + r->first_clip_vertex;
    const float4 a = clip[t.a], b = clip[t.b], c = clip[t.c];
    // The determinant of (x, y, w), which is linear homogeneous coordinates' signed area.
    const float x = fma(b.y, c.w, -(c.y * b.w)), y = fma(b.w, c.x, -(c.w * b.x)),
                w = fma(b.x, c.y, -(c.x * b.y));
    t.turns_left = fma(a.x, x, fma(a.y, y, a.w * w)) > 0.0f;
  }
  return t;
}

// Neighbours of a mesh go along the edge that they share in opposite directions. There are no branches, since
// they would be taken at random.
static inline bool is_edge(uint from, uint to, const SeenTriangle* t) {
  return ((from == t->a) & (to == t->b)) | ((from == t->b) & (to == t->c)) | ((from == t->c) & (to == t->a));
}

static inline bool are_neighbours(const SeenTriangle* s, const SeenTriangle* t) {
  return (s->instance == t->instance) & (s->instance != SURFACE_NONE) & (s->turns_left == t->turns_left) &
         (is_edge(s->b, s->a, t) | is_edge(s->c, s->b, t) | is_edge(s->a, s->c, t));
}

static inline void see_everywhere(global uint* triangles, uint number) {
#pragma unroll
  for (uint s = 0; s < SAMPLES; ++s) triangles[s] = number;
}

#ifdef SHADOWED
// Returns whether the triangle contains a pixel's centre, and its reversed depth there: no further than the
// samples are, between whose depths tiles list lights.
static inline bool holds_centre(const SeenTriangle* t, const SeenTriangles* scene, uint x, uint y,
                                float2 half_size, global const float* depths, float* depth) {
  global const float4* clip = scene->clip + scene->instances[t->instance].first_clip_vertex;
  const float4 a = clip[t->a], b = clip[t->b], c = clip[t->c];
  const float4 edges = screen_triangle(a, b, c, (float)x, (float)y, half_size).here;
  if (!(edges.x * edges.w >= 0.0f && edges.y * edges.w >= 0.0f && edges.z * edges.w >= 0.0f)) return false;
  const float at_centre = fma(edges.x, a.z, fma(edges.y, b.z, edges.z * c.z)) /
                          fma(edges.x, a.w, fma(edges.y, b.w, edges.z * c.w));
  float least = depths[0], most = depths[0];
  for (uint s = 1; s < SAMPLES; ++s) {
    least = min(least, depths[s]);
    most = max(most, depths[s]);
  }
  if (at_centre >= least)
    *depth = min(at_centre, most);
  else
    *depth = least;
  return true;
}
#endif

// triangles, depths: of a pixel's samples, which do not all see the same. Returns whether they see one
// surface. depth: the pixel's, which is another with -DSHADOWED.
static inline bool join_surfaces(global uint* triangles, const SeenTriangles* scene, uint x, uint y,
                                 float2 half_size, global const float* depths, float* depth) {
  SeenTriangle seen[SAMPLES];
  uint count = 0;
  for (uint left = ALL_SAMPLES; left != 0; left &= ~seen[count++].samples) {
    SeenTriangle* const t = seen + count;
    *t = seen_triangle(scene, triangles[lowest_bit(left)]);
#pragma unroll
    for (uint s = 0; s < SAMPLES; ++s) t->samples |= triangles[s] == t->number ? 1u << s : 0u;
  }
  // Bit k of surface[i]: triangle k belongs to the surface of triangle i. Neighbours come first; Warshall's
  // algorithm ("A Theorem on Boolean Matrices", 1962) adds their neighbours.
  uint surface[SAMPLES], some = 0;
  for (uint i = 0; i < count; ++i) {
    surface[i] = 1u << i;
    for (uint k = 0; k < i; ++k) {
      const uint joined = are_neighbours(seen + k, seen + i) ? 1u : 0u;
      surface[i] |= joined << k;
      surface[k] |= joined << i;
      some |= joined;
    }
  }
  if (!some) return false;
  for (uint k = 0; k < count; ++k)
    for (uint i = 0; i < count; ++i) surface[i] |= surface[i] >> k & 1u ? surface[k] : 0u;
  const bool one = surface[0] == (1u << count) - 1u;
#ifdef SHADOWED
  for (uint i = 0; one && i < count; ++i) {
    if (!holds_centre(seen + i, scene, x, y, half_size, depths, depth)) continue;
    see_everywhere(triangles, seen[i].number);
    return true;
  }
  return false;
#else
  for (uint i = 0; i < count; ++i) {
    uint most = lowest_bit(surface[i]);
    for (uint k = most + 1; k < count; ++k) {
      const bool more = popcount(seen[k].samples) > popcount(seen[most].samples);
      most = more & (surface[i] >> k & 1u) ? k : most;
    }
#pragma unroll
    for (uint s = 0; s < SAMPLES; ++s)
      triangles[s] = seen[i].samples >> s & 1u ? seen[most].number : triangles[s];
  }
  return one;
#endif
}
