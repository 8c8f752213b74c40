// The voxel light buffer: a volume of samples, each with the irradiance that arrives there and the sum of its
// directions. How kernels fill it, and where a point lies in it. Geldreich on Halo Wars (2009);
// docs/techniques/voxel_lights.md.
//   VOXELS_LOG: samples in the view's own projection: x / distance, y / distance and log2(distance). Without:
//   along three axes.
#pragma once

#include "shared/brdf.h"
#include "shared/volume_place.h"

// A brick of samples: a CPU's work-item fills one. Sizes of volumes are multiples of it.
#define VOXEL_BRICK_X 8
#define VOXEL_BRICK_Y 8
#define VOXEL_BRICK_Z 4
// A GPU's work-group fills fewer, of one slice, which fewer lights reach: a divisor of the brick along each
// axis. Each sample has several work-items, which share its lights.
#define VOXEL_GROUP_X 8
#define VOXEL_GROUP_Y 4
#define VOXEL_GROUP_SAMPLES (VOXEL_GROUP_X * VOXEL_GROUP_Y)
#define VOXEL_GROUP_ITEMS 128
// Lights that are neighbours in space share a box.
#define VOXEL_LIGHT_GROUP 16

#if defined(LIGHTGRID_GLSL)
#define VOXELS(member) voxel_lookup.member
#define VOXEL_ARGUMENT
#elif defined(__OPENCL_VERSION__)
#define VOXELS(member) voxels->member
#define VOXEL_ARGUMENT , constant VoxelLookup* voxels
#else
#define VOXELS(member) voxels.member
#define VOXEL_ARGUMENT , const VoxelLookup& voxels
namespace lightgrid {
#endif

#ifndef LIGHTGRID_GLSL
// The samples. Metres along the volume's axes; with VOXELS_LOG x and y are x / distance and y / distance.
// A table holds a VoxelSlice for each slice of equal z: what its samples share.
typedef struct VoxelGrid {
  uint size_x, size_y, size_z;  // samples
  uint groups;                  // groups of VOXEL_LIGHT_GROUP lights each
  float origin_x, origin_y;     // place of sample (0, 0)
  float spacing_x, spacing_y;
  float scale;    // stored value over real value
  float largest;  // value that is stored; a brighter sample keeps its colour and direction
} VoxelGrid;

// Metres and their squares.
typedef struct VoxelSlice {
  float place;                  // along the volume's z axis; with VOXELS_LOG the distance
  float half_diagonal_squared;  // for the cells between samples
  float core_squared;           // nearer than this a light counts as if it were this far away
  float unused;
} VoxelSlice;
#endif

// From view space to the volume. A place is counted in samples: 0 is the first one.
#ifdef LIGHTGRID_GLSL
layout(std140) uniform VoxelLookupBlock {
#else
typedef struct VoxelLookup {
#endif
  // Place along each axis: the sum of x, y and z times these, and the fourth.
  float x_from_x, x_from_y, x_from_z, x_from_1;
  float y_from_x, y_from_y, y_from_z, y_from_1;
  float z_from_x, z_from_y, z_from_z, z_from_1;
  // Directions in view space from those along the volume's axes.
  float view_x_from_x, view_x_from_y, view_x_from_z;
  float view_y_from_x, view_y_from_y, view_y_from_z;
  float view_z_from_x, view_z_from_y, view_z_from_z;
  float last_x, last_y, last_z;           // places of the last samples: sizes less 1
  float inverse_scale;                    // real value over stored value
  float spacing_x, spacing_y, spacing_z;  // metres, along the volume's axes
  // As in VoxelSlice; with VOXELS_LOG at distance 1: elsewhere they grow with the distance's square.
  float half_diagonal_squared, core_squared;
#ifdef LIGHTGRID_GLSL
  // clang-format off
} voxel_lookup;
// clang-format on
#else
} VoxelLookup;
#endif

// Clamped to the volume.
SHARED_FUNCTION Real3 voxel_place(Real3 position VOXEL_ARGUMENT) {
#ifdef VOXELS_LOG
  real distance = max_real(-position.z, REAL(1e-30f));
  Real3 q = real3(position.x / distance, position.y / distance, log2_of(distance));
#else
  Real3 q = position;
#endif
  return real3(
      place_along(q, VOXELS(x_from_x), VOXELS(x_from_y), VOXELS(x_from_z), VOXELS(x_from_1), VOXELS(last_x)),
      place_along(q, VOXELS(y_from_x), VOXELS(y_from_y), VOXELS(y_from_z), VOXELS(y_from_1), VOXELS(last_y)),
      place_along(q, VOXELS(z_from_x), VOXELS(z_from_y), VOXELS(z_from_z), VOXELS(z_from_1), VOXELS(last_z)));
}

// The volume's value at a point, interpolated: irradiance on a surface that faces each light, and the sum of
// the directions to the lights weighted by luminance, with the sum of the weights.
SHARED_STRUCT(VoxelLight) {
  Real3 irradiance, directions;
  real weight;
};

// From the volume's axes to view space.
SHARED_FUNCTION Real3 turned_to_view(Real3 d VOXEL_ARGUMENT) {
  return real3(component_along(d, VOXELS(view_x_from_x), VOXELS(view_x_from_y), VOXELS(view_x_from_z)),
               component_along(d, VOXELS(view_y_from_x), VOXELS(view_y_from_y), VOXELS(view_y_from_z)),
               component_along(d, VOXELS(view_z_from_x), VOXELS(view_z_from_y), VOXELS(view_z_from_z)));
}

// These take the stored numbers, remove their scale and turn them into view space.
#ifdef __OPENCL_VERSION__
#define GIVEN_LOOKUP , voxels
#elif defined(LIGHTGRID_GLSL)
#define GIVEN_LOOKUP
#else
#define GIVEN_LOOKUP , voxels
#endif
SHARED_FUNCTION VoxelLight voxel_light_in_view(VoxelLight stored VOXEL_ARGUMENT) {
  real scale = REAL(VOXELS(inverse_scale));
  VoxelLight light;
  light.irradiance = scale3(stored.irradiance, scale);
  light.directions = scale3(turned_to_view(stored.directions GIVEN_LOOKUP), scale);
  light.weight = stored.weight * scale;
  return light;
}

// The light that a surface reflects, in view space. The part in which directions agree counts as a light from
// their mean, the rest as if it came from all sides. Over all normals of a diffuse surface its mean and first
// moments are those of the lights.
SHARED_FUNCTION Real3 radiance_of_voxels(ShadingPoint p, VoxelLight light) {
  real squared = max_real(dot3(light.directions, light.directions), REAL(1.2e-38f));
  real inverse = inverse_sqrt_real(squared);
  real agreement = min_real(squared * inverse / max_real(light.weight, REAL(1.2e-38f)), REAL(1.0f));
  Real3 to_light = scale3(light.directions, inverse);
  real around = (1.0f - agreement) * (0.25f / SHADING_PI);  // radiance a unit of irradiance
  Real3 all_sides = AMBIENT_REFLECTANCE(p);
  Real3 back = add3(scale3(reflected(p, to_light), agreement), scale3(all_sides, around));
  return real3(back.x * light.irradiance.x, back.y * light.irradiance.y, back.z * light.irradiance.z);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
