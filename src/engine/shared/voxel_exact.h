// voxel-lights-exact: what one light adds to a voxel light buffer at a point, so that it can be taken out
// again and shaded by itself. kernels/voxels/voxel_light.h fills the volume by the same formulas
// (docs/techniques/voxel_lights.md); VoxelLights.ExactLightsLeaveNothingOfThemselves holds both together.
#pragma once

#include "shared/punctual_light.h"
#include "shared/voxel_volume.h"

// How much a light matters at a point.
SHARED_FUNCTION real voxel_importance(Arrival arrival, PunctualLight light) {
  return arrival.attenuation * (0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z);
}

// View space. position is at `place` in the volume.
SHARED_FUNCTION Real3 voxel_sample(Real3 position, Real3 place, Real3 sample_place VOXEL_ARGUMENT) {
#ifdef VOXELS_LOG
  real distance = exp2_of((sample_place.z - VOXELS(z_from_1)) / VOXELS(z_from_z));
  return real3((sample_place.x - VOXELS(x_from_1)) / VOXELS(x_from_x) * distance,
               (sample_place.y - VOXELS(y_from_1)) / VOXELS(y_from_y) * distance, -distance);
#else
  Real3 along =
      real3((sample_place.x - place.x) * VOXELS(spacing_x), (sample_place.y - place.y) * VOXELS(spacing_y),
            (sample_place.z - place.z) * VOXELS(spacing_z));
  return add3(position, turned_to_view(along GIVEN_LOOKUP));
#endif
}

// A light at a sample: its direction and its attenuation.
SHARED_FUNCTION Arrival arrival_at_sample(Real3 at, PunctualLight light VOXEL_ARGUMENT) {
  real grown = REAL(VOXELS(half_diagonal_squared)), core = REAL(VOXELS(core_squared));
#ifdef VOXELS_LOG
  grown = grown * (at.z * at.z);
  core = core * (at.z * at.z);
#endif
  Real3 d = offset_to_light(at, light);
  real squared = dot3(d, d);
  real growth = grown * light.position.w + 1.0f;
  real ratio = squared * light.position.w / growth;
#ifdef WINDOW_NONE
  real window = ratio < REAL(1.0f) ? REAL(1.0f) : REAL(0.0f);
#else
  real window = max_real(1.0f - ratio * ratio, REAL(0.0f));
#endif
#ifdef WINDOW_SMOOTH
  window = window * window;
#endif
  real inverse_squared = 1.0f / max_real(squared, REAL(1.2e-38f));
  real falloff = min_real(inverse_squared, 1.0f / core);
#ifdef VIRTUAL_LIGHTS
  falloff = min_real(falloff, REAL(light.max_falloff > 0.0f ? light.max_falloff : LARGEST_ATTENUATION));
#endif
#ifdef LEAST_FALLOFF
  falloff = max_real(falloff, REAL(light.color.w));
#endif
  Arrival arrival;
  arrival.to_light = scale3(d, sqrt_real(inverse_squared));
  arrival.attenuation = window * falloff * inverse_sqrt_real(growth);
#ifdef SPOTS
  float scale_squared =
      light.cone.x * light.cone.x + light.cone.y * light.cone.y + light.cone.z * light.cone.z;
  if (scale_squared > 0.0f) {
    float scale = sqrt(scale_squared), cos_outer = -light.cone.w / scale;
    real q = min_real(grown * inverse_squared, REAL(4.0f));
    real x = light.cone.w - (light.cone.x * arrival.to_light.x + light.cone.y * arrival.to_light.y +
                             light.cone.z * arrival.to_light.z);
    real soft_squared = scale_squared * q * ((1.0f - cos_outer * cos_outer) + 0.25f * q);
    real size = max_real(x, -x);
    real root = max_real(sqrt_real(x * x + soft_squared) + size, REAL(1e-30f));
    real y = x > REAL(0.0f) ? 0.5f * root : 0.5f * soft_squared / root;
    real angular = x < -4.0f * scale * sqrt_real(q) ? REAL(0.0f) : min_real(y, REAL(1.0f));
#ifdef VIRTUAL_LIGHTS
    real fade = light.max_falloff > 0.0f ? angular : angular * angular;
#else
    real fade = angular * angular;
#endif
    arrival.attenuation = arrival.attenuation * fade * ((1.0f - cos_outer) / ((1.0f - cos_outer) + 0.5f * q));
  }
#endif
  return arrival;
}

// The rest of the volume's light at a point without `share` of a light, which is 0 or 1.
SHARED_FUNCTION VoxelLight without_light(VoxelLight rest, Real3 position, PunctualLight light,
                                         real share VOXEL_ARGUMENT) {
  Real3 place = voxel_place(position GIVEN_LOOKUP);
  Real3 first = real3(min_real(floor(place.x), REAL(VOXELS(last_x) - 1.0f)),
                      min_real(floor(place.y), REAL(VOXELS(last_y) - 1.0f)),
                      min_real(floor(place.z), REAL(VOXELS(last_z) - 1.0f)));
  Real3 in_cell = real3(place.x - first.x, place.y - first.y, place.z - first.z);
  VoxelLight left = rest;
  for (uint corner = 0u; corner < 8u; ++corner) {
    bool x = (corner & 1u) != 0u, y = (corner & 2u) != 0u, z = (corner & 4u) != 0u;
    Real3 at = real3(first.x + (x ? 1.0f : 0.0f), first.y + (y ? 1.0f : 0.0f), first.z + (z ? 1.0f : 0.0f));
    real weight = share * (x ? in_cell.x : 1.0f - in_cell.x) * (y ? in_cell.y : 1.0f - in_cell.y) *
                  (z ? in_cell.z : 1.0f - in_cell.z);
    Arrival arrival = arrival_at_sample(voxel_sample(position, place, at GIVEN_LOOKUP), light GIVEN_LOOKUP);
    real part = weight * arrival.attenuation;
    real luminance = part * (0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z);
    left.irradiance =
        add3(left.irradiance, real3(-part * light.color.x, -part * light.color.y, -part * light.color.z));
    left.directions = add3(left.directions, scale3(arrival.to_light, -luminance));
    left.weight = left.weight - luminance;
  }
  return left;
}

// Rounding may leave a little less than nothing.
SHARED_FUNCTION VoxelLight at_least_nothing(VoxelLight light) {
  VoxelLight some = light;
  some.irradiance = real3(max_real(light.irradiance.x, REAL(0.0f)), max_real(light.irradiance.y, REAL(0.0f)),
                          max_real(light.irradiance.z, REAL(0.0f)));
  some.weight = max_real(light.weight, REAL(0.0f));
  return some;
}
