// How much of a light a shadow map hides from a point: percentage-closer filtering (Reeves, Salesin, Cook,
// "Rendering Antialiased Shadows with Depth Maps", SIGGRAPH 1987) with the receiver's plane (Isidoro, "Shadow
// Mapping: GPU-based Tips and Techniques", GDC 2006). docs/shadow_maps.md derives the bias.
//
// -DSHADOW_BITS   of a texel (shadow_texels.h)
// -DSHADOW_TAPS   texels a side that are asked: 1, 3 or 5
// -DLANES         points that are looked up at once: 16, or 1
#pragma once

#include "kernels/rays/rays.h"
#include "kernels/shadow_maps/shadow_texels.h"
#include "shared/shadow_face.h"

#ifndef SHADOW_TAPS
#define SHADOW_TAPS 1
#endif

#define SHADOW_MAPS_ARGUMENTS \
  global const uint2 *shadow_lights, global const ShadowFace *shadow_faces, global const Texel *shadow_texels
#define SHADOW_MAPS \
  { shadow_lights, shadow_faces, shadow_texels }

typedef struct ShadowMaps {
  global const uint2* lights;  // first face, and number of faces (shadow_atlas.h)
  global const ShadowFace* faces;
  global const Texel* texels;
} ShadowMaps;

// LANES points of triangles, relative to the scene's origin.
typedef struct ShadowReceivers {
  Real3 at, corners[3];
  Real3 normal;  // unit, of either sign
  real gap;      // metres in front of the point in which nothing hides it
} ShadowReceivers;

static inline ShadowReceivers shadow_receivers(const RayScene* scene, Real3 at, whole own, real gap,
                                               uint live) {
#if LANES == 16
  float corners[9][16] = {{0}};
  int numbers[16];
  vstore16(own, 0, numbers);
  for (uint lane = 0; lane < 16; ++lane) {
    float of[9];
    if (!(live >> lane & 1)) continue;
    rays_triangle(scene, (uint)numbers[lane], of);
    for (int k = 0; k < 9; ++k) corners[k][lane] = of[k];
  }
#define RECEIVER_CORNER(k) \
  real3(vload16(0, corners[3 * k]), vload16(0, corners[3 * k + 1]), vload16(0, corners[3 * k + 2]))
#else
  float corners[9];
  rays_triangle(scene, (uint)own, corners);
#define RECEIVER_CORNER(k) real3(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2])
#endif
  const Real3 a = RECEIVER_CORNER(0), b = RECEIVER_CORNER(1), c = RECEIVER_CORNER(2),
              back = scale3(a, REAL(-1.0f));
  const Real3 across = cross3(add3(b, back), add3(c, back));
  ShadowReceivers r = {at, {a, b, c}, scale3(across, 1.0f / sqrt(dot3(across, across))), gap};
  return r;
}

static inline real along(global const float* axis, Real3 v) {
  return axis[0] * v.x + axis[1] * v.y + axis[2] * v.z;
}

static inline Real3 in_face(global const ShadowFace* f, Real3 p) {
  return real3(p.x - f->from[0], p.y - f->from[1], p.z - f->from[2]);
}

// The number of the face that sees `to`: +x, -x, +y, -y, +z, -z.
static inline whole cube_face(Real3 to) {
  const real x = fabs(to.x), y = fabs(to.y), z = fabs(to.z);
  const mask_t of_x = (x >= y) & (x >= z), of_y = y >= z;
  const whole axis = of_x ? (whole)(0) : of_y ? (whole)(2) : (whole)(4);
  return axis + ((of_x ? to.x : of_y ? to.y : to.z) < 0.0f ? (whole)(1) : (whole)(0));
}

// Texels (x, y), 0 for lanes that are not live.
static inline real texels_at(global const Texel* texels, uint size, whole x, whole y, uint live) {
#if LANES == 16
  int at[16];
  float values[16] = {0};
  vstore16(y * (whole)((int)size) + x, 0, at);
  for (uint left = live; left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    values[lane] = (float)texels[at[lane]];
  }
  return vload16(0, values);
#else
  return live ? (float)texels[y * (int)size + x] : 0.0f;
#endif
}

// A face's coordinates of receivers: of their points, normals, and of their triangles' furthest corners.
typedef struct FaceReceivers {
  real x, y, z, nx, ny, nz, furthest;
  real u, v;  // the points' places in texels
  float to_texels, half_size;
} FaceReceivers;

static inline FaceReceivers receivers_in_face(global const ShadowFace* f, const ShadowReceivers* r) {
  const Real3 to = in_face(f, r->at);
  FaceReceivers p;
  p.x = along(f->right, to);
  p.y = along(f->up, to);
  p.z = along(f->ahead, to);
  p.nx = along(f->right, r->normal);
  p.ny = along(f->up, r->normal);
  p.nz = along(f->ahead, r->normal);
  p.furthest = p.z;
  for (int k = 0; k < 3; ++k) p.furthest = lane_max(p.furthest, along(f->ahead, in_face(f, r->corners[k])));
  p.u = f->parallel ? p.x : p.x / p.z;
  p.v = f->parallel ? p.y : p.y / p.z;
  p.half_size = 0.5f * (float)f->size;
  p.to_texels = p.half_size / f->extent;
  return p;
}

// Lanes of which all taps lie in the face.
static inline mask_t all_taps_in(const FaceReceivers* p) {
  const float most = p->half_size - (float)(SHADOW_TAPS / 2);
  return (fabs(p->u) * p->to_texels < most) & (fabs(p->v) * p->to_texels < most);
}

static inline whole taps_of_face(const ShadowMaps* maps, global const ShadowFace* f, const ShadowReceivers* r,
                                 const FaceReceivers* p, uint live) {
  const real plane = p->nx * p->x + p->ny * p->y + p->nz * p->z;
  const real side = f->parallel ? p->nz : plane;
  const real turn = side < 0.0f ? REAL(-1.0f) : REAL(1.0f);
  const float from = sqrt(f->from[0] * f->from[0] + f->from[1] * f->from[1] + f->from[2] * f->from[2]);
  const real rounding = 0x1p-21f * (from + sqrt(dot3(r->at, r->at)));
  const real in_front = f->parallel ? r->gap : r->gap * p->z / sqrt(p->x * p->x + p->y * p->y + p->z * p->z);
  const float step = 1.0f / p->to_texels, metres = 1.0f / texel_scale(f->range_m);
  const real most = REAL((float)(f->size - 1));
  const real x = lane_floor(p->u * p->to_texels + p->half_size),
             y = lane_floor(p->v * p->to_texels + p->half_size);
  whole hidden = (whole)(0);
  for (int j = -(SHADOW_TAPS / 2); j <= SHADOW_TAPS / 2; ++j) {
    for (int i = -(SHADOW_TAPS / 2); i <= SHADOW_TAPS / 2; ++i) {
      const real tx = lane_min(lane_max(x + (float)i, REAL(0.0f)), most);
      const real ty = lane_min(lane_max(y + (float)j, REAL(0.0f)), most);
      const real u = (tx + (0.5f - p->half_size)) * step, v = (ty + (0.5f - p->half_size)) * step;
      // Where the texel's centre sees the receiver's plane, but no further than the triangle goes.
      const real across = p->nx * u + p->ny * v;
      const real facing = turn * (f->parallel ? p->nz : across + p->nz);
      const real at_plane = turn * (f->parallel ? plane - across : plane) / facing;
      const real expected = facing > 0.0f ? lane_min(at_plane, p->furthest) : p->furthest;
      const real length = f->parallel ? REAL(1.0f) : sqrt(u * u + v * v + 1.0f);
      const real bias =
          in_front + texel_step(f->range_m, expected) + rounding * length / lane_max(facing, REAL(0x1p-10f));
      const real stored = texels_at(maps->texels + f->first, f->size, TO_WHOLE(tx), TO_WHOLE(ty), live);
      const mask_t nearer = (stored != TEXEL_NOTHING) & (stored * metres < expected - bias);
      hidden += nearer ? (whole)(1) : (whole)(0);
    }
  }
  const mask_t asked = lanes_of(live) & (p->z > 0.0f);
  return asked ? hidden : (whole)(0);
}

// The number of taps that see something nearer than the receiver: 0 to SHADOW_TAPS^2 for each lane of
// `active`. A point takes its face of a cube, or the first cascade that holds all taps; outside of the last
// it is lit.
static inline whole shadow_taps(const ShadowMaps* maps, uint light, const ShadowReceivers* r, mask_t active) {
  const uint2 of = maps->lights[light];
  global const ShadowFace* first = maps->faces + of.x;
  const whole face = of.y == 6 ? cube_face(in_face(first, r->at)) : (whole)(0);
  whole taps = (whole)(0);
  uint left = lane_bits(active);
  for (uint i = 0; i < of.y && left != 0; ++i) {
    if (of.y == 6 && lane_bits(face == (whole)((int)i)) == 0) continue;
    const FaceReceivers p = receivers_in_face(first + i, r);
    const uint live = left & lane_bits(of.y == 6 ? face == (whole)((int)i) : all_taps_in(&p) & (p.z > 0.0f));
    if (live != 0) taps += taps_of_face(maps, first + i, r, &p, live);
    left &= ~live;
  }
  return taps;
}
