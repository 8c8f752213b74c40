// The rasteriser's host and kernels share these structs, which hold 32-bit scalars only.
#pragma once

#include "shared/language.h"

#define RASTER_TILE 64         // pixels a side
#define RASTER_CLUSTER 64      // triangles at most
#define RASTER_BLOCK 256       // records that room is handed out in
#define RASTER_SCAN_GROUP 128  // work-items that add up a scan on GPUs
#define RASTER_BUCKETS 256     // distance buckets by which clusters are sorted
#define RASTER_HIDDEN 255      // the bucket of clusters out of view
#define RASTER_VERTEX_RUN \
  1024  // vertices of an instance that a work-item transforms in one go, a multiple of 16
#define RASTER_NO_CONE 2.0f
#define RASTER_NONE 0xffffffffu
#define RASTER_NOT_DRAWN 0xfffffffeu

// Counters that the host reads after a frame.
#define RASTER_VISIBLE 0  // clusters that may be in view
#define RASTER_BLOCKS 1   // blocks of records that were asked for
#define RASTER_RECORDS 2
#define RASTER_INVALID 3  // triangles with a corner that is not finite
// Low word, then high word: pairs of a record and a tile, or a window (raster/gpu/raster_small.cl).
#define RASTER_ENTRIES 4
#define RASTER_LARGE 6      // records of triangles that are not drawn at once, in the group shape
#define RASTER_NEXT_TILE 7  // the first tile that no work-item of raster/cpu/raster_tiles.cl has taken yet
#define RASTER_COUNTERS 8

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

typedef struct RasterParams {
  float half_x, half_y;    // half the view's size, in 1/256 pixel
  float guard_x, guard_y;  // the guard band's edge in normalized device coordinates
  uint width, height;      // pixels
  uint tiles_x, tiles_y;
  uint pairs;  // pairs of an instance and one of its mesh's clusters
  uint vertex_runs;
  uint chunks;                         // chunks of clusters in view: one work-item sets up each
  uint record_blocks, entry_capacity;  // room
  uint cones;                          // 1: clusters that face away are left out
  uint drawing_order;                  // 1: clusters stay in the order of their instances, not nearest first
} RasterParams;

// An instance in this frame.
typedef struct RasterFrameInstance {
  float clip_from_object[16];  // rows
  // Where the view is perspective the eye, else the direction that it looks in; object space.
  float eye_x, eye_y, eye_z;
  uint eye_is_point;  // RASTER_NONE: cones do not apply; RASTER_NOT_DRAWN: no other member is set
} RasterFrameInstance;

// Some triangles of a mesh that lie together; object space.
typedef struct RasterCluster {
  float center_x, center_y, center_z;
  float half_x, half_y, half_z;  // the box around them; infinite where a position is not finite
  float radius;                  // radius of the sphere around the center that holds them
  float axis_x, axis_y, axis_z;  // unit, of the cone that holds their normals
  float sine;                    // sine of the cone's half-angle; RASTER_NO_CONE from 90 degrees on
  uint first, count;             // range of all meshes' triangles, in the order of clusters
  uint pad0, pad1, pad2;
} RasterCluster;

// A triangle on the screen, or a part of one that clipping left, counter-clockwise.
typedef struct RasterRecord {
  int x[3], y[3];      // 1/256 pixel
  float z0, zx, zy;    // depth at the anchor (kernels/raster/raster_tiles.h), and what it gains per pixel
  float z_min, z_max;  // depths of the part in view
  uint triangle;       // its number
  uint box_low;        // first and last pixel of which a sample may be covered, x | y << 16
  uint box_high;
  uint instance;
  int alpha_material;  // below 0: opaque
} RasterRecord;

#if !defined(__OPENCL_VERSION__)
}  // namespace lightgrid
#endif
