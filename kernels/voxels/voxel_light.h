// Adds a light to LANES samples of a voxel light buffer, which lie in one slice.
// docs/techniques/voxel_lights.md has the reasons: a light's reach is grown so that the samples around each
// lit point get a part of it, and dimmed by as much.
//
// -DVOXEL_BITS  16 or 32: bits of a stored value (default 32)
// -DSPOTS       some light has a cone
// -DWINDOW_SMOOTH, -DWINDOW_NONE, -DLEAST_FALLOFF  shared/punctual_light.h
// -DVOXELS_LOG  shared/voxel_volume.h
#pragma once

#include "shared/light_table.h"
#include "shared/voxel_volume.h"

#ifndef VOXEL_BITS
#define VOXEL_BITS 32
#endif

#if VOXEL_BITS == 16
typedef half voxel_t;
#define STORE_VOXEL(value, to) vstore_half4(value, 0, to)
#else
typedef float voxel_t;
#if LANES == 1
#define STORE_VOXEL(value, to) *(global float4*)(to) = value  // aligned, which vstore4 does not know
#else
#define STORE_VOXEL(value, to) vstore4(value, 0, to)
#endif
#endif

// The largest value of one light at one sample, and of all of them on a sample that is written: finite in all
// products that shading makes.
#define LARGEST_VOXEL 1e15f

// Lights by groups of VOXEL_LIGHT_GROUP. What pads the last group is far away.
typedef struct VoxelLights {
  // The boxes of groups, six planes of VOXEL_LIGHT_GROUP groups each: least and greatest x, y, z
  global const float* boxes;
  // The places of a group's lights: x, y, z and radius, VOXEL_LIGHT_GROUP each, along the volume's axes
  global const float* places;
  global const float4* colors;  // radiant intensity, and the least 1 / distance^2
#ifdef SPOTS
  // scale 0: no cone. Axis times scale, offset (shared/punctual_light.h), scale, 1 - cosine and
  // squared sine of the half-angle, the most falloff of a virtual light
  global const float8* cones;
#endif
} VoxelLights;

// Axis-aligned, along the volume's axes.
typedef struct VoxelBox {
  float low_x, low_y, low_z, high_x, high_y, high_z;
} VoxelBox;

// The box of count_x * count_y * count_z samples from (x, y, z) on.
static inline VoxelBox box_of_samples(constant VoxelGrid* grid, constant VoxelSlice* slices, uint x, uint y,
                                      uint z, uint count_x, uint count_y, uint count_z) {
  const float x0 = grid->origin_x + (float)x * grid->spacing_x,
              y0 = grid->origin_y + (float)y * grid->spacing_y;
  const float x1 = grid->origin_x + (float)(x + count_x - 1) * grid->spacing_x;
  const float y1 = grid->origin_y + (float)(y + count_y - 1) * grid->spacing_y;
  const float z0 = slices[z].place, z1 = slices[z + count_z - 1].place;
  VoxelBox b = {x0, y0, z0, x1, y1, z1};
#ifdef VOXELS_LOG
  b.low_x = fmin(x0 * z0, x0 * z1);
  b.high_x = fmax(x1 * z0, x1 * z1);
  b.low_y = fmin(y0 * z0, y0 * z1);
  b.high_y = fmax(y1 * z0, y1 * z1);
  b.low_z = -z1;
  b.high_z = -z0;
#endif
  return b;
}

// Slightly more than the largest square that add_voxel_light adds to a light's squared radius in these
// slices, and what its distances may be rounded by.
static inline float grown_by(constant VoxelSlice* slices, uint z, uint count) {
  float most = slices[z].half_diagonal_squared;
  for (uint i = 1; i < count; ++i) most = fmax(most, slices[z + i].half_diagonal_squared);
  return most;
}

static inline real outside(real low, real high, float from, float to) {
  return lane_max(lane_max(REAL(from) - high, low - REAL(to)), REAL(0.0f));
}

// Lanes whose ball of this radius, grown, may hold a sample of the box.
static inline mask_t may_light(real x, real y, real z, real radius, const VoxelBox* b, float grown) {
  const real dx = outside(x, x, b->low_x, b->high_x), dy = outside(y, y, b->low_y, b->high_y);
  const real dz = outside(z, z, b->low_z, b->high_z);
  return dx * dx + dy * dy + dz * dz < (radius * radius + grown) * 1.0001f;
}

// Lanes whose box of balls, grown, meets the box.
static inline mask_t may_meet(real low_x, real low_y, real low_z, real high_x, real high_y, real high_z,
                              const VoxelBox* b, float grown) {
  const real dx = outside(low_x, high_x, b->low_x, b->high_x),
             dy = outside(low_y, high_y, b->low_y, b->high_y);
  const real dz = outside(low_z, high_z, b->low_z, b->high_z);
  return dx * dx + dy * dy + dz * dz <= REAL(grown * 1.0001f);
}

typedef struct VoxelSum {
  Real3 irradiance, directions;
  real weight, lights;
} VoxelSum;

static inline real luminance_of(Real3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

// A light's radius in a slice.
typedef struct VoxelReach {
  float squared, inverse_squared;
  // Over the ball of its reach a light adds up to its intensity times the radius, whatever the window
  float dimmed;
} VoxelReach;

static inline VoxelReach voxel_reach(float radius, constant VoxelSlice* slice) {
  VoxelReach r;
  r.squared = radius * radius + slice->half_diagonal_squared;
  r.inverse_squared = 1.0f / r.squared;
  r.dimmed = radius * sqrt(r.inverse_squared);
  return r;
}

// A spot's attenuation. Its edge is rounded over a cell's angle, whose square is q. y (y - x) = soft^2 / 4.
static inline real voxel_cone(float8 cone, Real3 d, real inverse_squared, real inverse,
                              constant VoxelSlice* slice) {
  const real q = lane_min(slice->half_diagonal_squared * inverse_squared, REAL(4.0f));
  const real x = (cone.s0 * d.x + cone.s1 * d.y + cone.s2 * d.z) * inverse + cone.s3;
  const real soft_squared = cone.s4 * cone.s4 * q * (cone.s6 + 0.25f * q);
  const real root = lane_max(sqrt(x * x + soft_squared) + fabs(x), REAL(1e-30f));
  const real y = x > REAL(0.0f) ? 0.5f * root : 0.5f * soft_squared / root;
  const real angular = x < -4.0f * cone.s4 * sqrt(q) ? REAL(0.0f) : lane_min(y, REAL(1.0f));
#ifdef VIRTUAL_LIGHTS
  const real fade = cone.s7 > 0.0f ? angular : angular * angular;
#else
  const real fade = angular * angular;
#endif
  return fade * (cone.s5 / (cone.s5 + 0.5f * q));
}

// A light's attenuation at samples, 0 outside its reach or its cone, and 1 / distance. d: to the
// light, from position. color, cone: as in VoxelLights; cone is unread without SPOTS.
typedef struct VoxelArrival {
  real attenuation, inverse;
} VoxelArrival;

static inline VoxelArrival voxel_arrival(Real3 position, float3 place, Real3 d, real squared,
                                         constant VoxelSlice* slice, VoxelReach reach, float4 color,
                                         float8 cone) {
  const real ratio = squared * reach.inverse_squared;
#ifdef WINDOW_NONE
  real window = 1.0f;
#else
  real window = lane_max(1.0f - ratio * ratio, REAL(0.0f));
#endif
#ifdef WINDOW_SMOOTH
  window = window * window;
#endif
  VoxelArrival a;
  const real inverse_squared = 1.0f / lane_max(squared, REAL(1.2e-38f));
  a.inverse = sqrt(inverse_squared);
  real falloff = lane_min(inverse_squared, REAL(1.0f / slice->core_squared));
#ifdef VIRTUAL_LIGHTS
  if (cone.s7 > 0.0f) falloff = lane_min(falloff, REAL(cone.s7));
#endif
#ifdef LEAST_FALLOFF
  falloff = lane_max(falloff, REAL(color.w));
#endif
  a.attenuation = window * falloff * reach.dimmed;
#ifdef SPOTS
  if (cone.s4 != 0.0f) a.attenuation = a.attenuation * voxel_cone(cone, d, inverse_squared, a.inverse, slice);
#endif
  a.attenuation = squared < REAL(reach.squared) ? a.attenuation : REAL(0.0f);
  return a;
}

static inline Real3 voxel_irradiance(real attenuation, float4 color) {
  return real3(lane_min(attenuation * color.x, REAL(LARGEST_VOXEL)),
               lane_min(attenuation * color.y, REAL(LARGEST_VOXEL)),
               lane_min(attenuation * color.z, REAL(LARGEST_VOXEL)));
}

// place: x, y and z of the light.
static inline void add_voxel_light(VoxelSum* sum, Real3 position, constant VoxelSlice* slice, float3 place,
                                   VoxelReach reach, const VoxelLights* lights, uint light) {
  const Real3 d = real3(place.x - position.x, place.y - position.y, place.z - position.z);
  const real squared = dot3(d, d);
  if (!any_lane(squared < REAL(reach.squared))) return;
  const float4 color = lights->colors[light];
#ifdef SPOTS
  const float8 cone = lights->cones[light];
#else
  const float8 cone = (float8)(0.0f);
#endif
  const VoxelArrival a = voxel_arrival(position, place, d, squared, slice, reach, color, cone);
  const Real3 arrives = voxel_irradiance(a.attenuation, color);
  const real weight = luminance_of(arrives), along_weight = weight * a.inverse;
  sum->irradiance = add3(sum->irradiance, arrives);
  sum->directions = add3(sum->directions, real3(along_weight * d.x, along_weight * d.y, along_weight * d.z));
  sum->weight += weight;
  sum->lights += a.attenuation > REAL(0.0f) ? REAL(1.0f) : REAL(0.0f);
}

// Scaled for storing.
static inline VoxelSum as_stored(VoxelSum s, constant VoxelGrid* grid) {
  const real brightest =
      lane_max(lane_max(s.irradiance.x, s.irradiance.y), lane_max(s.irradiance.z, s.weight));
  const real scale = lane_min(REAL(grid->scale), grid->largest / lane_max(brightest, REAL(1e-30f)));
  s.irradiance = scale3(s.irradiance, scale);
  s.directions = scale3(s.directions, scale);
  s.weight *= scale;
  return s;
}
