// Triangles that one pixel's samples see and that are one surface: triangles of an instance that share an
// edge and turn the same way on the screen. Attributes and positions go on across a shared edge, and such
// triangles lie on opposite sides of it in the image, so that none hides the other within the pixel. A
// silhouette, a crease or a seam whose corners have vertices of their own, and another instance, stay apart.
//
// All samples of such a surface get the number of its triangle that most of them see, the first of equals.
#pragma once

#include "kernels/resolve/samples.h"
#include "shared/raster_instance.h"

// What a triangle number leads to: the rasteriser's.
typedef struct SeenTriangles {
  global const uint* triangle_instance;
  global const RasterInstanceRecord* instances;
  global const uint* indices;
  global const float4* clip;
} SeenTriangles;

typedef struct SeenTriangle {
  uint number, samples, count;  // samples: a bit each
  uint instance, a, b, c;
  bool turns_left;  // counter-clockwise on the screen; told of two-sided ones
} SeenTriangle;

static inline SeenTriangle seen_triangle(const SeenTriangles* s, uint number) {
  SeenTriangle t = {number, 0, 0, SURFACE_NONE, 0, 0, 0, false};
  if (number == SURFACE_NONE) return t;
  t.instance = s->triangle_instance[number];
  global const RasterInstanceRecord* r = s->instances + t.instance;
  global const uint* index = s->indices + r->first_index + 3 * (size_t)(number - r->first_triangle);
  t.a = index[0], t.b = index[1], t.c = index[2];
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

// Each goes along an edge that they share in its own direction, as neighbours of a mesh do.
static inline bool is_edge(uint from, uint to, const SeenTriangle* t) {
  return (from == t->a && to == t->b) || (from == t->b && to == t->c) || (from == t->c && to == t->a);
}

static inline bool are_neighbours(const SeenTriangle* s, const SeenTriangle* t) {
  return s->instance == t->instance && s->instance != SURFACE_NONE && s->turns_left == t->turns_left &&
         (is_edge(s->b, s->a, t) || is_edge(s->c, s->b, t) || is_edge(s->a, s->c, t));
}

// `triangles`: of a pixel's samples, which do not all see the same. Returns whether they see one surface.
static inline bool join_surfaces(global uint* triangles, const SeenTriangles* scene) {
  SeenTriangle seen[SAMPLES];
  uint count = 0;
  for (uint left = ALL_SAMPLES; left != 0;) {
    uint first = 0;
    while (!(left >> first & 1u)) ++first;
    SeenTriangle t = seen_triangle(scene, triangles[first]);
    for (uint s = first; s < SAMPLES; ++s)
      if (left >> s & 1u && triangles[s] == t.number) t.samples |= 1u << s, ++t.count;
    left &= ~t.samples;
    seen[count++] = t;
  }
  // of[i]: the surface of triangle i, by the first of its triangles.
  uint of[SAMPLES];
  bool joined = false;
  for (uint i = 0; i < count; ++i) {
    of[i] = i;
    for (uint k = 0; k < i; ++k) {
      if (of[k] == of[i] || !are_neighbours(seen + k, seen + i)) continue;
      const uint low = min(of[k], of[i]), high = max(of[k], of[i]);
      for (uint m = 0; m <= i; ++m)
        if (of[m] == high) of[m] = low;
      joined = true;
    }
  }
  if (!joined) return false;
  bool one = true;
  for (uint i = 0; i < count; ++i) {
    one = one && of[i] == 0;
    if (of[i] != i) continue;
    uint most = i, samples = 0;
    for (uint k = i; k < count; ++k) {
      if (of[k] != i) continue;
      samples |= seen[k].samples;
      if (seen[k].count > seen[most].count) most = k;
    }
    for (uint s = 0; s < SAMPLES; ++s)
      if (samples >> s & 1u) triangles[s] = seen[most].number;
  }
  return one;
}
