// Light cells: a cube around a point light, each of whose six faces has size x size cells. A cell lists the
// triangles that a shadow ray into it may meet, nearest first. The host and the kernels of kernels/rays share
// these structs. docs/rays.md has the method.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A triangle as a light sees it: the planes that the test of rays/ray_packet.h makes, with the same bits.
// Relative to the light, turned so that the triangle is on their positive side.
typedef struct LightCellTriangle {
  float normal[3], offset;
  float edge_0[3];
  uint place;  // in RayScene::triangles
  float edge_1[3];
  float near;  // metres; no shorter ray meets the triangle
  float edge_2[3];
  uint padding;
} LightCellTriangle;

typedef struct LightCellEntry {
  uint triangle;  // number of a LightCellTriangle
  float near;     // metres; no shorter ray into the cell meets the triangle
} LightCellEntry;

// A light's cells: `size` squared and one starts for each face. Size 0: it has no lists.
typedef struct LightCellTable {
  uint first_start, size;
  float squared;  // of the longest rays that lists serve, metres
} LightCellTable;

// A light whose lists are made.
typedef struct LightCellJob {
  double x, y, z;  // relative to the origin of the rays' scene, metres
  float reach_m;   // no ray is longer
  uint gathered;   // out of the first step: triangles in leaves within reach
  uint size, first_start, first_triangle, first_entry;
  uint entry_room;          // for 16 entries more than there are, or they are only counted
  uint padding;
  uint triangles, entries;  // out of the second
} LightCellJob;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(LightCellTriangle) == 64 && sizeof(LightCellEntry) == 8 && sizeof(LightCellJob) == 64);
}  // namespace lightgrid
#endif
