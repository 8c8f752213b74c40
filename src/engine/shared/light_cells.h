// Light cells: size x size cells on each face of a cube around a point light, or on one grid across the
// direction of a directional light. A cell lists the triangles that a shadow ray through it may meet, those
// next to the light first. The host and the kernels of kernels/rays share these structs.
// docs/rays.md has the method.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A triangle as a light sees it: the planes of the test in rays/ray_packet.h, with the same bits, and their
// offsets. The triangle is on their positive side. For a point light they are relative to it, and edges have
// no offsets: edge_0[3] stores the bits of the triangle's place in RayScene::triangles. A directional light's
// triangles are stored in the order of their places.
typedef struct LightCellTriangle {
  float normal[4], edge_0[4], edge_1[4], edge_2[4];
} LightCellTriangle;

typedef struct LightCellEntry {
  uint triangle;  // number of a LightCellTriangle
  float near;     // metres; no shorter ray into the cell meets the triangle
} LightCellEntry;

// The cells of a directional light: x = u . p + u[3], y = v . p + v[3] of a point p, cut off to whole numbers
// from 0 to size - 1. The point's ray is as long as it lies below the plane toward . p = top. Of a spot light:
// `toward` is its axis, and only rays within an angle of it have lists, whose cosine is `top`. Of other point
// lights `top` is below -1.
typedef struct LightCellGrid {
  float u[4], v[4], toward[3], top;
} LightCellGrid;

// A light's cells: `size` squared and one starts for each face. Size 0: it has no lists.
typedef struct LightCellTable {
  uint first_start, size;
  float squared;        // m^2: of the longest ray that lists serve, or of the farthest point's distance
  uint first_triangle;  // only for a directional light
  LightCellGrid grid;
} LightCellTable;

// A light whose lists are made.
typedef struct LightCellJob {
  double x, y, z, w;  // RaySource of kernels/rays/ray_packet.h
  float reach_m;      // no ray is longer
  uint gathered;      // out of the first step: triangles in leaves within reach
  uint size, first_start, first_triangle, first_entry;
  uint entry_room;  // entries: 16 more than there are, or they are only counted
  uint padding;
  uint triangles, entries;         // out of the second
  float low[3], high[3];           // out of the first, of a directional light: a box of all triangles
  LightCellGrid grid;              // in for the second, of a directional light
  float metres_u[3], metres_v[3];  // u and v over their squares
  float extent_m;     // 4 times the greatest sum of magnitudes of a corner's coordinates, or more
  float list_length;  // out of the second: entries of a cell, on average over entries
} LightCellJob;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(LightCellTriangle) == 64 && sizeof(LightCellEntry) == 8 && sizeof(LightCellJob) == 176);
}  // namespace lightgrid
#endif
