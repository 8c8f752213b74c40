// The share of a sphere light that is hidden from a pixel, by SHADOW_RAYS rays (4 to 256).
//
// The light is the disc of its radius around its centre that faces the pixel's point. Samples lie on Vogel's
// spiral, sample i at the radius sqrt((i + u) / K) and i golden angles further round: one in each of K rings
// of equal area (H. Vogel, "A better way to construct the sunflower head", 1979). The hash of pixel and light
// turns the spiral and chooses u. Each place of the disc is then as likely as any other, and the share's mean
// over pixels has no bias.
//
// Roles are exchanged: the packet's origin is the pixel's point, and its lanes are samples of the light. They
// make one narrow cone, and every pixel has a pattern of its own. Only rounding to nearest is used, so that
// all forms and devices give the same bytes.
#pragma once

#include "kernels/common/hash.h"
#include "kernels/shadows/receivers.h"

#ifndef SHADOW_RAYS
#define SHADOW_RAYS 1  // kernels/shadows/picked_shadows.h alone
#endif

#define GOLDEN_ANGLE 0x9e3779b9u  // of 2^32, a whole turn, from the other side

// One lane of Receivers.
typedef struct SoftReceiver {
  float x, y, z, gap;
  float normal_x, normal_y, normal_z;  // unit, or 0
  int own;
} SoftReceiver;

static inline float dot_of(float ax, float ay, float az, float bx, float by, float bz) {
  return fma(az, bz, fma(ay, by, ax * bx));
}

// sin(pi x) for x from -1/2 to 1/2: Taylor's series, to within 4e-6.
static inline real sine_of_half_turns(real x) {
  const real s = x * x;
  return x * fma(fma(fma(fma(REAL(0.082145887f), s, REAL(-0.59926453f)), s, REAL(2.5501640f)), s,
                     REAL(-5.1677128f)),
                 s, REAL(3.1415927f));
}

// Numbers of lanes, from `first` on.
static inline whole lanes_from(uint first) {
#if LANES == 16
  return LANE_INDEX + (int)first;
#else
  return (int)first;
#endif
}

// Samples i of `count` on the unit disc.
static inline void disc_samples(whole i, uint count, uint turned, float u, real* x, real* y) {
#if LANES == 16
  const whole turn = as_int16(as_uint16(i) * GOLDEN_ANGLE + turned);
#else
  const whole turn = (int)((uint)i * GOLDEN_ANGLE + turned);
#endif
  const real t = TO_REAL(turn) * 0x1p-32f, away = fabs(t);  // turns, from -1/2 to 1/2
  const real r = sqrt((TO_REAL(i) + u) * (1.0f / count));
  const real sine = sine_of_half_turns(0.5f - fabs(2.0f * away - 0.5f));
  *x = r * sine_of_half_turns(0.5f - 2.0f * away);
  *y = r * (t < 0.0f ? -sine : sine);
}

// The number of hidden samples, of which `away` are hidden without a ray; with blended casters in
// 255ths.
static inline uint hidden_in_samples(const RayScene* scene, RaySource origin, Real3 to, mask_t active,
                                     mask_t away, int own, int* last_blocker) {
#ifdef RAYS_VEILS
  const whole shares = rays_share(scene, origin, to, REAL(0.0f), active, (whole)(own), last_blocker);
  uint hidden = 255u * popcount(lane_bits(away));
  for (uint left = lane_bits(active); left != 0; left &= left - 1)
    hidden += (uint)((const int*)&shares)[lowest_bit(left)];
  return hidden;
#else
  return popcount(
      lane_bits(away | rays_hidden(scene, origin, to, REAL(0.0f), active, (whole)(own), last_blocker)));
#endif
}

static inline float hash_in_unit(uint h) { return (float)(mixed(h ^ 0x68bc21ebu) >> 8) * 0x1p-24f; }

// The number of hidden samples. `seed`: of pixel and light.
static inline uint hidden_samples(const RayScene* scene, const SoftReceiver* r, global const ShadowLight* l,
                                  uint seed, uint* traced, int* last_blocker) {
  const float x = (float)(l->x - r->x), y = (float)(l->y - r->y), z = (float)(l->z - r->z);
  const float distance = sqrt(dot_of(x, y, z, x, y, z)), radius = l->source_m;
  if (!(distance > r->gap)) return 0;
  // The disc's axes: T. Duff et al., "Building an orthonormal basis, revisited", JCGT 2017.
  const float nx = x / distance, ny = y / distance, nz = z / distance, sign = nz < 0 ? -1.0f : 1.0f;
  const float a = -1.0f / (sign + nz), b = nx * ny * a;
  const float ax = fma(sign * nx * nx, a, 1.0f), ay = sign * b, az = -sign * nx;
  const float bx = b, by = fma(ny * ny, a, sign), bz = -ny;
  // Above the plane of the pixel's triangle: the light's centre, and what its axes add.
  const float height = dot_of(r->normal_x, r->normal_y, r->normal_z, x, y, z);
  const float height_a = dot_of(r->normal_x, r->normal_y, r->normal_z, ax, ay, az) * radius,
              height_b = dot_of(r->normal_x, r->normal_y, r->normal_z, bx, by, bz) * radius;
  // Rays begin a gap before the point, on the way to the light or, where it is low, to a place as high as
  // the highest sample: below none of the rays, and above the triangles beside the pixel's in one plane.
  const float raised = height < radius ? radius - height : 0.0f;
  const float tx = fma(raised, r->normal_x, x), ty = fma(raised, r->normal_y, y),
              tz = fma(raised, r->normal_z, z);
  const float step = r->gap / sqrt(dot_of(tx, ty, tz, tx, ty, tz));
  const RaySource origin = {(double)r->x + step * tx, (double)r->y + step * ty, (double)r->z + step * tz, 1};
  const float lx = (float)l->x, ly = (float)l->y, lz = (float)l->z;
  const uint turned = mixed(seed);
  const float u = hash_in_unit(turned);
  uint hidden = 0;
  for (uint first = 0; first < SHADOW_RAYS; first += LANES) {
    real p, q;
    const whole i = lanes_from(first);
    const mask_t used = i < (whole)(SHADOW_RAYS);
    disc_samples(i, SHADOW_RAYS, turned, u, &p, &q);
    const mask_t away = used & (fma(q, REAL(height_b), fma(p, REAL(height_a), REAL(height))) < 0.0f),
                 active = used & ~away;
    p *= radius;
    q *= radius;
    const Real3 to =
        real3(fma(q, REAL(bx), fma(p, REAL(ax), REAL(lx))), fma(q, REAL(by), fma(p, REAL(ay), REAL(ly))),
              fma(q, REAL(bz), fma(p, REAL(az), REAL(lz))));
    *traced += popcount(lane_bits(active));
    hidden += hidden_in_samples(scene, origin, to, active, away, r->own, last_blocker);
  }
  return hidden;
}

// A triangle that lets light through has no side that is dark: its normal is 0.
static inline SoftReceiver soft_receiver(const Receivers* r, uint lane) {
#define LANE_OF(v) ((const float*)&(v))[lane]
  const float x = LANE_OF(r->normal.x), y = LANE_OF(r->normal.y), z = LANE_OF(r->normal.z);
  const float length = sqrt(dot_of(x, y, z, x, y, z)),
              inverse = length > 0.0f && r->own_hides ? 1.0f / length : 0.0f;
  const SoftReceiver s = {LANE_OF(r->at.x), LANE_OF(r->at.y), LANE_OF(r->at.z), LANE_OF(r->gap),
                          x * inverse,      y * inverse,      z * inverse,      ((const int*)&r->own)[lane]};
  return s;
#undef LANE_OF
}

// x, y: of lane 0.
static inline uint hash_of_pixel(uint x, uint y, uint lane) {
  return mixed((x + (lane & 3u)) << 16 | (y + (lane >> 2)));
}

// The share as a byte.
static inline int byte_of(uint hidden, uint rays) {
#ifdef RAYS_VEILS
  return (int)((hidden + rays / 2) / rays);
#else
  return (int)((hidden * 255u + rays / 2) / rays);
#endif
}

// 0 to 255: the share of the light that is hidden from each lane. x, y: the pixel of lane 0; others as in
// shared/shadow_bits.h.
static inline whole soft_share(const RayScene* scene, const Receivers* r, global const ShadowLight* l, uint x,
                               uint y, uint light, uint* traced, int* last_blocker) {
  uint left = lane_bits(may_shade(r, l));
  whole shares = (whole)(0);
  for (; left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    const SoftReceiver one = soft_receiver(r, lane);
    const uint seed = hash_of_pixel(x, y, lane) + light * GOLDEN_ANGLE;
    const uint hidden = hidden_samples(scene, &one, l, seed, traced, last_blocker);
    ((int*)&shares)[lane] = byte_of(hidden, SHADOW_RAYS);
  }
  return shares;
}
