// One estimate, for each pixel, of the share of its shadowed light that is hidden: by SHADOW_PICK rays (1, 4
// or 16) in all, to lights drawn from its tile's list, each as likely as it is bright there. Light loops then
// multiply the unshadowed sum by one share, so that there is noise in shadows alone: the ratio estimator of
// E. Heitz, S. Hill, M. McGuire, "Combining analytic direct illumination and stochastic shadows", I3D 2018.
//
// Rays of hard shadows are those of ray_test.h: lanes that draw the same light share a packet. With
// -DSHADOW_RAYS a ray goes to a place on its light's sphere and roles are exchanged as in soft_shadows.h: the
// lanes of a packet are the rays of one pixel.
#pragma once

#include "kernels/shadows/ray_test.h"
#include "kernels/shadows/soft_shadows.h"

// The light that a Lambert surface reflects, times a factor that is the same for all lights of a pixel. It is
// not exact: cones fade from their axis on, and the surface's own reflectance is left out.
static inline real estimated_light(const Receivers* r, whole masks, global const ShadowLight* l) {
  const Real3 d = real3(from_double(r->at.x, l->x), from_double(r->at.y, l->y), from_double(r->at.z, l->z));
  const real squared = lane_max(fma(d.z, d.z, fma(d.y, d.y, d.x * d.x)), REAL(1e-6f));
  const real inverse = 1.0f / sqrt(squared), part = squared * (1.0f / l->reach_squared);
  const real facing = -fma(d.z, r->normal.z, fma(d.y, r->normal.y, d.x * r->normal.x)) * inverse;
  real light =
      lane_max(facing, REAL(0.0f)) * lane_max(fma(-part, part, REAL(1.0f)), REAL(0.0f)) * inverse * inverse;
  if (l->cos_outer > -1.0f) {
    const real along = fma(d.z, REAL(l->axis_z), fma(d.y, REAL(l->axis_y), d.x * l->axis_x)) * inverse;
    const real inside = lane_max((along - l->cos_outer) / fmax(1.0f - l->cos_outer, 1e-7f), REAL(0.0f));
    light *= inside * inside;
  }
  return (r->own >= (whole)(0)) & ((masks & (whole)((int)l->mask)) != (whole)(0)) ? light * l->luminance
                                                                                  : REAL(0.0f);
}

// The masks of each lane's surface: all of them if triangle_masks is null.
static inline whole masks_of_lanes(const Receivers* r, global const uint* triangle_masks) {
  whole masks = (whole)(-1);
  if (!triangle_masks) return masks;
  for (uint left = lane_bits(r->own >= (whole)(0)); left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    ((int*)&masks)[lane] = (int)triangle_masks[((const int*)&r->own)[lane]];
  }
  return masks;
}

#define PICK_OF(pick, lane) (((const int*)&(pick))[lane])

// Draws the lights of each lane, in systematic steps over the sum of all. Lanes to which no light adds
// anything have none: a light of another mask adds nothing.
// picks: SHADOW_PICK lights of each lane, those that are alike in succession. x, y: of lane 0.
static inline mask_t pick_lights(const Receivers* r, whole masks, global const ShadowLight* lights,
                                 global const index_t* indices, uint2 range, uint x, uint y, whole* picks) {
  real sum = REAL(0.0f), before = REAL(0.0f), next = REAL(0.0f), u = REAL(0.0f);
  for (uint i = range.x; i < range.x + range.y; ++i) sum += estimated_light(r, masks, lights + indices[i]);
  for (uint lane = 0; lane < LANES; ++lane) ((float*)&u)[lane] = hash_in_unit(hash_of_pixel(x, y, lane));
  whole count = (whole)(0);
  const real step = sum * (1.0f / SHADOW_PICK);
  next = u * step;
  for (uint i = range.x; i < range.x + range.y; ++i) {
    const uint index = indices[i];
    before += estimated_light(r, masks, lights + index);
    for (uint left = lane_bits((before > next) & (count < (whole)(SHADOW_PICK))); left != 0;
         left &= left - 1) {
      const uint lane = lowest_bit(left);
      const float end = ((const float*)&before)[lane], wide = ((const float*)&step)[lane],
                  at = ((const float*)&u)[lane];
      int n = ((const int*)&count)[lane];
      do ((int*)&picks[n++])[lane] = (int)index;
      while (n < SHADOW_PICK && end > ((float)n + at) * wide);
      ((int*)&count)[lane] = n;
      ((float*)&next)[lane] = ((float)n + at) * wide;
    }
  }
  return count == (whole)(SHADOW_PICK);
}

#if SHADOW_RAYS > 1
// The number of a pixel's rays that are hidden.
static inline uint hidden_picks(const RayScene* scene, const SoftReceiver* r,
                                global const ShadowLight* lights, const whole* picks, uint lane_of_picks,
                                uint seed, uint* traced, int* last_blocker) {
  // A gap off the surface: the rays have no common direction.
  const RaySource origin = {(double)r->x + r->gap * r->normal_x, (double)r->y + r->gap * r->normal_y,
                            (double)r->z + r->gap * r->normal_z, 1};
  const uint turned = mixed(seed ^ 0x2c1b3c6du);
  const float u = hash_in_unit(turned);
  uint hidden = 0;
  for (uint first = 0; first < SHADOW_PICK; first += LANES) {
    real x = REAL(0.0f), y = x, z = x, at_x = x, at_y = x, at_z = x, radius = x;
    for (uint lane = 0; lane < LANES && first + lane < SHADOW_PICK; ++lane) {
      global const ShadowLight* l = lights + PICK_OF(picks[first + lane], lane_of_picks);
      ((float*)&x)[lane] = (float)(l->x - r->x);
      ((float*)&at_x)[lane] = (float)l->x;
      ((float*)&y)[lane] = (float)(l->y - r->y);
      ((float*)&at_y)[lane] = (float)l->y;
      ((float*)&z)[lane] = (float)(l->z - r->z);
      ((float*)&at_z)[lane] = (float)l->z;
      ((float*)&radius)[lane] = l->source_m;
    }
    // The rings of the lights' discs are dealt out by another hash, or the first lights would have the inner.
    real p, q;
    const whole i = lanes_from(first);
    disc_samples((i + (int)(mixed(turned) >> 8)) & (SHADOW_PICK - 1), SHADOW_PICK, turned, u, &p, &q);
    p *= radius;
    q *= radius;
    const real squared = fma(z, z, fma(y, y, x * x)), inverse = 1.0f / sqrt(squared);
    const real nx = x * inverse, ny = y * inverse, nz = z * inverse,
               sign = nz < 0.0f ? REAL(-1.0f) : REAL(1.0f);
    const real a = -1.0f / (sign + nz), b = nx * ny * a;
    const Real3 off = real3(fma(q, b, p * fma(sign * nx * nx, a, REAL(1.0f))),
                            fma(q, fma(ny * ny, a, sign), p * sign * b), -fma(q, ny, p * sign * nx));
    const real height =
        fma(z + off.z, REAL(r->normal_z), fma(y + off.y, REAL(r->normal_y), (x + off.x) * r->normal_x));
    const mask_t used = (i < (whole)(SHADOW_PICK)) & (squared > r->gap * r->gap),
                 away = used & (height < 0.0f), active = used & ~away;
    *traced += popcount(lane_bits(active));
    hidden += hidden_in_samples(scene, origin, real3(at_x + off.x, at_y + off.y, at_z + off.z), active, away,
                                r->own, last_blocker);
  }
  return hidden;
}

// The hidden shares of the lanes `drawn`.
static inline whole share_of_picks(ShadowTest* test, const RayScene* scene, const Receivers* r,
                                   global const ShadowLight* lights, const whole* picks, mask_t drawn, uint x,
                                   uint y) {
  whole shares = (whole)(0);
  for (uint left = lane_bits(drawn); left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    const SoftReceiver one = soft_receiver(r, lane);
    const uint hidden = hidden_picks(scene, &one, lights, picks, lane, hash_of_pixel(x, y, lane),
                                     &test->traced, &test->last_blocker);
    ((int*)&shares)[lane] = byte_of(hidden, SHADOW_PICK);
  }
  return shares;
}
#else
static inline whole share_of_picks(ShadowTest* test, const RayScene* scene, const Receivers* r,
                                   global const ShadowLight* lights, const whole* picks, mask_t drawn, uint x,
                                   uint y) {
  whole sum = (whole)(SHADOW_PICK / 2), share = (whole)(0);
  for (uint i = 0; i < SHADOW_PICK; ++i) {
    const whole pick = picks[i];
    for (uint left = lane_bits(i == 0 ? drawn : drawn & (pick != picks[i - 1])); left != 0;) {
      const uint light = (uint)PICK_OF(pick, lowest_bit(left));
      const mask_t here = lanes_of(left) & (pick == (whole)((int)light));
      left &= ~lane_bits(here);
      const whole hidden = hidden_by_test(test, scene, r, light, lights + light, here);
      share = here ? hidden : share;
    }
    sum += share;
  }
  return drawn ? sum / SHADOW_PICK : (whole)(0);
}
#endif

// 0 to 255: of the light that each lane's pixel has from the tile's lights, the share that is hidden.
static inline whole picked_share(ShadowTest* test, const RayScene* scene, const Receivers* r,
                                 global const ShadowLight* lights, global const index_t* indices, uint2 range,
                                 uint x, uint y) {
  whole picks[SHADOW_PICK];
  const whole masks = masks_of_lanes(r, test->triangle_masks);
  const mask_t drawn = pick_lights(r, masks, lights, indices, range, x, y, picks);
  return share_of_picks(test, scene, r, lights, picks, drawn, x, y);
}

// Only one light: lights behind the pixel's own triangle are never drawn, and are hidden for certain.
static inline whole picked_or_away(const RayScene* scene, const Receivers* r, global const ShadowLight* l,
                                   whole shares, constant ShadowView* v) {
  const mask_t reached = may_shade(r, l);
  if (!any_lane(reached)) return shares;
  return turned_away(scene, r, l, reached, v) ? (whole)(255) : shares;
}
