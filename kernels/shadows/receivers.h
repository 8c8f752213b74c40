// Where LANES pixels ask for shadows: the point that a pixel shades, moved onto the plane of its own triangle,
// and on which side of that plane the eye is.
//
// -DSHADOW_MAP    what shadow maps need to know of the triangle is kept (kernels/shadow_maps/shadow_maps.h)
// -DBANDS         of the frame's tiles only some are looked at (BAND_ARGUMENTS)
// -DNUMBERED      triangles come by the rays' numbers, else by the rasteriser's
// -DORTHOGRAPHIC  shared/pixel_position.h
#pragma once

#include "kernels/common/index_type.h"
#include "kernels/rays/rays.h"
#include "kernels/shadows/kept_pairs.h"
#ifdef SHADOW_MAP
#include "kernels/shadow_maps/shadow_maps.h"
#endif
#include "shared/light_grid.h"
#include "shared/pixel_position.h"
#include "shared/shadow_bits.h"
#include "shared/shadow_records.h"

// triangles          a pixel each, row 0 at the bottom
// triangle_instance  the rasteriser's instance of a triangle
// number_offsets     by instance: added to its triangles' numbers they are the rays' numbers. Both are null
//                    with -DNUMBERED
// depths             reversed, a pixel each
// cells, indices     lists of lights in tiles (shared/light_grid.h)
// image, first_entry 0 of opaque surfaces, else 1 + that of a layer, and how many entries those before it have
// own_hides          1: the pixel's own triangle hides lights behind it; 0: it lets light through
// tiles, bits        out: shared/shadow_bits.h
// rays               out: how many were traced, a tile
// BAND_ARGUMENTS     the first tile of the band, and for each tile of each image the band's entries before it
#ifdef BANDS
#define BAND_ARGUMENTS , uint first_tile, global const uint *first_entries
#define FIRST_TILE first_tile
#define FIRST_ENTRY(own_tile, range) first_entries[own_tile]
#else
#define BAND_ARGUMENTS
#define FIRST_TILE 0
#define FIRST_ENTRY(own_tile, range) (first_entry + (range).x)
#endif
#define SHADOW_PASS_ARGUMENTS                                                                            \
  RAYS_ARGUMENTS, global const uint *triangles, global const uint *triangle_instance,                    \
      global const int *number_offsets, global const float *depths, global const uint2 *cells,           \
      global const index_t *indices, global const ShadowLight *lights, constant ShadowView *shadow_view, \
      constant ViewParams *view, uint image, uint first_entry, uint own_hides, global uint2 *tiles,      \
      global uint *bits, global uint *rays BAND_ARGUMENTS KEPT_ARGUMENTS

#define NO_TRIANGLE 0xffffffffu

typedef struct Receivers {
  Real3 shaded;  // where shading asks for range and cone; up to the rasteriser's snapping beside the plane
  Real3 at;      // in the plane
  real gap;      // metres before it in which nothing hides it
  whole own;     // the triangle's number; below 0: none
  Real3 normal;  // of its plane, towards the eye; 0: the eye is in the plane
  real slack;    // what rounds a distance along it, without the light's part
  uint own_hides;
#ifdef SHADOW_MAP
  ShadowReceivers for_maps;
#endif
} Receivers;

static inline uint ray_number(uint triangle, global const uint* triangle_instance,
                              global const int* number_offsets) {
#ifdef NUMBERED
  return triangle;
#else
  return (uint)((int)triangle + number_offsets[triangle_instance[triangle]]);
#endif
}

// Distance of a point (w 1) from the triangle's plane, or of a direction's end (w 0) from where it begins,
// times any positive number. Exact but for roundings of doubles.
static inline double plane_distance(global const RayTriangle* t, double x, double y, double z, double w) {
  return t->normal[0] * (x - w * t->corners[0]) + t->normal[1] * (y - w * t->corners[1]) +
         t->normal[2] * (z - w * t->corners[2]);
}

static inline real size_of(Real3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

// Into the lanes that are `here` their triangle.
static inline void add_plane(Receivers* r, global const RayTriangle* t, mask_t here, constant ShadowView* v) {
  const double side = plane_distance(t, v->eye_x, v->eye_y, v->eye_z, v->eye_w);
  const float turn = side > 0 ? 1.0f : side < 0 ? -1.0f : 0.0f;
  const float nx = (float)t->normal[0], ny = (float)t->normal[1], nz = (float)t->normal[2];
  const float squared = fma(nz, nz, fma(ny, ny, nx * nx)), inverse = squared > 0.0f ? 1.0f / squared : 0.0f;
  const Real3 from = real3(r->at.x - t->corners[0], r->at.y - t->corners[1], r->at.z - t->corners[2]);
  const real off = fma(from.z, REAL(nz), fma(from.y, REAL(ny), from.x * nx)) * inverse;
  const Real3 on_plane =
      real3(fma(-off, REAL(nx), r->at.x), fma(-off, REAL(ny), r->at.y), fma(-off, REAL(nz), r->at.z));
  // A dot product with the rounded normal, and the point's own distance from the plane.
  const real slack = 0x1p-20f * (size_of(r->at) + size_of(from));
  r->at.x = here ? on_plane.x : r->at.x;
  r->at.y = here ? on_plane.y : r->at.y;
  r->at.z = here ? on_plane.z : r->at.z;
  r->slack = here ? slack : r->slack;
  r->normal.x = here ? REAL(nx * turn) : r->normal.x;
  r->normal.y = here ? REAL(ny * turn) : r->normal.y;
  r->normal.z = here ? REAL(nz * turn) : r->normal.z;
  r->own = here ? (whole)((int)(t->number & ~RAY_MASKED)) : r->own;
}

#if LANES == 16
// The pixels of a block of 4 x 4 from (x, y) on that lie in the image and show a triangle.
static inline mask_t covered_lanes(uint16 triangle, uint x, uint y, uint width, uint height) {
  return (LANE_INDEX & 3) < (int16)((int)(width - x)) & (LANE_INDEX >> 2) < (int16)((int)(height - y)) &
         (triangle != (uint16)(NO_TRIANGLE));
}
#endif

// Where a surface is shaded: without planes, which add_plane completes. x, y: pixels' centres.
static inline Receivers receivers_at(mask_t covered, real x, real y, real depth, uint own_hides,
                                     constant ShadowView* v, constant ViewParams* view) {
  Receivers r;
  r.own_hides = own_hides;
  const Real3 p = position_of_pixel(x, y, covered ? depth : REAL(1.0f), view);
  constant float* m = v->world_from_view;
  r.at.x = fma(p.z, REAL(m[2]), fma(p.y, REAL(m[1]), p.x * m[0])) + v->from_x;
  r.at.y = fma(p.z, REAL(m[5]), fma(p.y, REAL(m[4]), p.x * m[3])) + v->from_y;
  r.at.z = fma(p.z, REAL(m[8]), fma(p.y, REAL(m[7]), p.x * m[6])) + v->from_z;
  r.shaded = r.at;
  r.gap = fma(REAL(SHADOW_GAP_SHARE), sqrt(fma(r.at.z, r.at.z, fma(r.at.y, r.at.y, r.at.x * r.at.x))),
              REAL(SHADOW_GAP_M));
  r.own = (whole)(-1);
  r.normal = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
  r.slack = REAL(0.0f);
  return r;
}

#ifdef SHADOW_MAP
static inline void add_corners(Receivers* r, const RayScene* scene) {
  const uint live = lane_bits(r->own >= (whole)(0));
  if (live != 0) r->for_maps = shadow_receivers(scene, r->at, r->own, r->gap, live);
}
#endif

// Lanes that the light may shade, in its range and its cone.
static inline mask_t may_shade(const Receivers* r, global const ShadowLight* l) {
  const Real3 p = r->shaded;
  const Real3 d = real3(from_double(p.x, l->x), from_double(p.y, l->y), from_double(p.z, l->z));
  const real squared = fma(d.z, d.z, fma(d.y, d.y, d.x * d.x));
  mask_t reached = (r->own >= (whole)(0)) & (squared <= REAL(l->reach_squared));
  if (l->cos_outer > -1.0f) {
    const real along = fma(d.z, REAL(l->axis_z), fma(d.y, REAL(l->axis_y), d.x * l->axis_x));
    reached &= along + l->slack >= (l->cos_outer - 1e-5f) * sqrt(squared);
  }
  return reached;
}

// Lanes whose own triangle is between eye and light: they see its other side than the light.
static inline mask_t turned_away(const RayScene* scene, const Receivers* r, global const ShadowLight* l,
                                 mask_t of, constant ShadowView* v) {
  if (!r->own_hides) return (mask_t)(0);
  const real x = (float)l->x, y = (float)l->y, z = (float)l->z;
  const real w = (float)l->w;
  const Real3 to = real3(fma(-w, r->at.x, x), fma(-w, r->at.y, y), fma(-w, r->at.z, z));
  const real distance = fma(to.z, r->normal.z, fma(to.y, r->normal.y, to.x * r->normal.x));
  const real slack = w * r->slack + 0x1p-20f * (fabs(x) + fabs(y) + fabs(z));
  mask_t away = of & (distance < -slack);
  const mask_t unsure = of & (fabs(distance) <= slack);
  for (uint left = lane_bits(unsure); left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
#if LANES == 16
    const int number = ((const int*)&r->own)[lane];
#else
    const int number = r->own;
#endif
    global const RayTriangle* t = scene->triangles + scene->places[number];
    const double light = plane_distance(t, l->x, l->y, l->z, l->w),
                 eye = plane_distance(t, v->eye_x, v->eye_y, v->eye_z, v->eye_w);
    if ((light < 0 && eye > 0) || (light > 0 && eye < 0)) away |= lanes_of(1u << lane);
  }
  return away;
}
