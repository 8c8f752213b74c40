// The voxel light buffer at LANES points: what kernels/*/build_voxels.cl wrote, interpolated between the
// eight samples around each of them.
//
// -DVOXEL_BITS, -DVOXELS_LOG  as kernels/voxels/voxel_light.h says
#pragma once

#include "shared/voxel_volume.h"

#ifndef VOXEL_BITS
#define VOXEL_BITS 32
#endif

#if VOXEL_BITS == 16
typedef half stored_voxel_t;
#define TWO_VOXELS(from) ((float8)(vload_half4(0, from), vload_half4(1, from)))  // each aligned to its size
#else
typedef float stored_voxel_t;
#if LANES == 16
#define TWO_VOXELS(from) vload8(0, from)
#else
#define TWO_VOXELS(from) ((float8)(*(global const float4*)(from), *(global const float4*)((from) + 4)))
#endif
#endif

// Two samples along x, between rows and slices. `at`: the first of them; a row and a
// slice: the number of values in it.
static inline float4 between_voxels(global const stored_voxel_t* at, size_t row, size_t slice, float x,
                                    float y, float z) {
  const float8 a = TWO_VOXELS(at), b = TWO_VOXELS(at + row), c = TWO_VOXELS(at + slice),
               d = TWO_VOXELS(at + slice + row);
  const float8 low = fma(b - a, (float8)(y), a), high = fma(d - c, (float8)(y), c);
  const float8 both = fma(high - low, (float8)(z), low);
  return fma(both.hi - both.lo, (float4)(x), both.lo);
}

#if LANES == 16
#define VOXEL_LANE(v, i) (((float*)&(v))[i])
#define VOXEL_FRACTION(v, i) (((const float*)&(v))[i])
#define VOXEL_INDEX(v, i) (((const int*)&(v))[i])
#else
#define VOXEL_LANE(v, i) (v)
#define VOXEL_FRACTION(v, i) (v)
#define VOXEL_INDEX(v, i) (v)
#endif

// In view space. Of lanes that are not `lit`: zeros.
static inline VoxelLight voxel_light_at(Real3 position, mask_t lit, global const stored_voxel_t* irradiance,
                                        global const stored_voxel_t* directions,
                                        constant VoxelLookup* voxels) {
  const Real3 place = voxel_place(position, voxels);
  const size_t row = 4 * ((size_t)voxels->last_x + 1), slice = row * ((size_t)voxels->last_y + 1);
  // The last sample is the far end of the last cell.
  const real x0 = lane_min(floor(place.x), REAL(voxels->last_x - 1.0f)),
             y0 = lane_min(floor(place.y), REAL(voxels->last_y - 1.0f));
  const real z0 = lane_min(floor(place.z), REAL(voxels->last_z - 1.0f));
  const real x = place.x - x0, y = place.y - y0, z = place.z - z0;
  const whole ix = TO_WHOLE(x0), iy = TO_WHOLE(y0), iz = TO_WHOLE(z0);
  VoxelLight light = {{0}};
#if LANES == 16
  for (uint bits = mask_bits(lit); bits != 0; bits &= bits - 1) {
    const uint i = lowest_bit(bits);
#else
  const uint i = 0;
  if (lit) {
#endif
    const size_t at = (size_t)VOXEL_INDEX(iz, i) * slice + (size_t)VOXEL_INDEX(iy, i) * row +
                      4 * (size_t)VOXEL_INDEX(ix, i);
    const float fx = VOXEL_FRACTION(x, i), fy = VOXEL_FRACTION(y, i), fz = VOXEL_FRACTION(z, i);
    const float4 e = between_voxels(irradiance + at, row, slice, fx, fy, fz);
    const float4 d = between_voxels(directions + at, row, slice, fx, fy, fz);
    VOXEL_LANE(light.irradiance.x, i) = e.x;
    VOXEL_LANE(light.irradiance.y, i) = e.y;
    VOXEL_LANE(light.irradiance.z, i) = e.z;
    VOXEL_LANE(light.directions.x, i) = d.x;
    VOXEL_LANE(light.directions.y, i) = d.y;
    VOXEL_LANE(light.directions.z, i) = d.z;
    VOXEL_LANE(light.weight, i) = d.w;
  }
  return voxel_light_in_view(light, voxels);
}
