// Fills a voxel light buffer, for CPUs: a work-item takes a brick of samples, collects the lights that may
// reach it, and adds them up, 4 x 4 samples of a slice at once. Each sample is the sum of its lights in
// their order, whatever the device.
//
// boxes, places, colors, cones  of lights by groups (kernels/voxels/voxel_light.h); cones only with -DSPOTS
// grid, slices  where samples lie (shared/voxel_volume.h)
// irradiance    out: four values a sample, x fastest: red, green, blue, number of lights
// directions    out: the same: x, y, z of directions times weights along the volume's axes, and the weights
// -D names of kernels/voxels/voxel_light.h
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/voxels/voxel_light.h"

#define COLUMNS (VOXEL_BRICK_X / 4)
#define VECTORS (COLUMNS * (VOXEL_BRICK_Y / 4) * VOXEL_BRICK_Z)
#define CHUNK 128u  // lights that are added at once
#if VOXEL_BITS == 16
#define STORE_4_VOXELS(values, to) vstore_half16(values, 0, to)
#else
#define STORE_4_VOXELS(values, to) vstore16(values, 0, to)
#endif

// Where the lights are that may reach a brick, 16 side by side.
typedef struct FoundLights {
  float x[CHUNK + VOXEL_LIGHT_GROUP], y[CHUNK + VOXEL_LIGHT_GROUP], z[CHUNK + VOXEL_LIGHT_GROUP];
  float radius[CHUNK + VOXEL_LIGHT_GROUP];
} FoundLights;

static inline void add_lights(VoxelSum* sums, const uint* found, uint count, const VoxelLights* lights,
                              constant VoxelGrid* grid, constant VoxelSlice* slices, uint x, uint y, uint z) {
  FoundLights at;
  VoxelReach reaches[CHUNK + VOXEL_LIGHT_GROUP];
  for (uint i = 0; i < count; ++i) {
    global const float* of = lights->places + found[i] / VOXEL_LIGHT_GROUP * (4 * VOXEL_LIGHT_GROUP) +
                             found[i] % VOXEL_LIGHT_GROUP;
    at.x[i] = of[0];
    at.y[i] = of[VOXEL_LIGHT_GROUP];
    at.z[i] = of[2 * VOXEL_LIGHT_GROUP];
    at.radius[i] = of[3 * VOXEL_LIGHT_GROUP];
  }
  for (uint v = 0; v < VECTORS; ++v) {
    const uint column = v % COLUMNS * 4, row = v / COLUMNS % (VOXEL_BRICK_Y / 4) * 4;
    constant VoxelSlice* slice = slices + z + v / (VECTORS / VOXEL_BRICK_Z);
    if (v % (VECTORS / VOXEL_BRICK_Z) == 0) {
      // Once a slice.
      for (uint i = 0; i < count; ++i) reaches[i] = voxel_reach(at.radius[i], slice);
    }
    Real3 position =
        real3(grid->origin_x + convert_float16((int)(x + column) + (LANE_INDEX & 3)) * grid->spacing_x,
              grid->origin_y + convert_float16((int)(y + row) + (LANE_INDEX >> 2)) * grid->spacing_y,
              REAL(slice->place));
#ifdef VOXELS_LOG
    position = real3(position.x * position.z, position.y * position.z, -position.z);
#endif
    // Which lights reach any of the 16 samples cannot be predicted: those that miss their box are
    // left out 16 at once. Conservative: a light that reaches a sample reaches the box, and
    // may_light rounds its reach up.
    const VoxelBox box = {position.x.s0, position.y.s0, position.z.s0,
                          position.x.sf, position.y.sf, position.z.s0};
    VoxelSum sum = sums[v];
    for (uint first = 0; first < count; first += 16) {
      const mask_t meets =
          may_light(vload16(0, at.x + first), vload16(0, at.y + first), vload16(0, at.z + first),
                    vload16(0, at.radius + first), &box, slice->half_diagonal_squared);
      const uint valid = count - first < 16 ? (1u << (count - first)) - 1u : 0xffffu;
      for (uint bits = mask_bits(meets) & valid; bits != 0; bits &= bits - 1) {
        const uint i = first + lowest_bit(bits);
        add_voxel_light(&sum, position, slice, (float3)(at.x[i], at.y[i], at.z[i]), reaches[i], lights,
                        found[i]);
      }
    }
    sums[v] = sum;
  }
}

static inline float16 side_by_side(float4 a, float4 b, float4 c, float4 d) {
  return (float16)(a.x, b.x, c.x, d.x, a.y, b.y, c.y, d.y, a.z, b.z, c.z, d.z, a.w, b.w, c.w, d.w);
}

// Four values of 4 x 4 samples; `stride` is from row to row.
static inline void store_samples(real a, real b, real c, real d, global voxel_t* to, size_t stride) {
  STORE_4_VOXELS(side_by_side(a.lo.lo, b.lo.lo, c.lo.lo, d.lo.lo), to);
  STORE_4_VOXELS(side_by_side(a.lo.hi, b.lo.hi, c.lo.hi, d.lo.hi), to + stride);
  STORE_4_VOXELS(side_by_side(a.hi.lo, b.hi.lo, c.hi.lo, d.hi.lo), to + 2 * stride);
  STORE_4_VOXELS(side_by_side(a.hi.hi, b.hi.hi, c.hi.hi, d.hi.hi), to + 3 * stride);
}

kernel ONE_ITEM void build_voxels(global const float* boxes, global const float* places,
                                  global const float4* colors, global const float8* cones,
                                  constant VoxelGrid* grid, constant VoxelSlice* slices,
                                  global voxel_t* irradiance, global voxel_t* directions) {
  ASSUME_ONE_ITEM;
  const uint x = get_global_id(0) * VOXEL_BRICK_X, y = get_global_id(1) * VOXEL_BRICK_Y,
             z = get_global_id(2) * VOXEL_BRICK_Z;
#ifdef SPOTS
  const VoxelLights lights = {boxes, places, colors, cones};
#else
  const VoxelLights lights = {boxes, places, colors};
#endif
  const VoxelBox box = box_of_samples(grid, slices, x, y, z, VOXEL_BRICK_X, VOXEL_BRICK_Y, VOXEL_BRICK_Z);
  const float grown = grown_by(slices, z, VOXEL_BRICK_Z);
  VoxelSum sums[VECTORS];
  const VoxelSum none = {{0}};
  for (uint v = 0; v < VECTORS; ++v) sums[v] = none;
  uint found[CHUNK + VOXEL_LIGHT_GROUP];
  uint count = 0;
  for (uint group = 0; group < grid->groups; group += 16) {
    global const float* b = boxes + 6 * group;
    const mask_t meets = may_meet(vload16(0, b), vload16(1, b), vload16(2, b), vload16(3, b), vload16(4, b),
                                  vload16(5, b), &box, grown);
    for (uint met = mask_bits(meets); met != 0; met &= met - 1) {
      const uint first = (group + lowest_bit(met)) * VOXEL_LIGHT_GROUP;
      global const float* at = places + 4 * first;
      const mask_t reach =
          may_light(vload16(0, at), vload16(1, at), vload16(2, at), vload16(3, at), &box, grown);
      for (uint bits = mask_bits(reach); bits != 0; bits &= bits - 1)
        found[count++] = first + lowest_bit(bits);
      if (count < CHUNK) continue;
      add_lights(sums, found, count, &lights, grid, slices, x, y, z);
      count = 0;
    }
  }
  add_lights(sums, found, count, &lights, grid, slices, x, y, z);
  for (uint v = 0; v < VECTORS; ++v) {
    const VoxelSum s = as_stored(sums[v], grid);
    const uint column = v % COLUMNS * 4, row = v / COLUMNS % (VOXEL_BRICK_Y / 4) * 4,
               slice = v / (VECTORS / VOXEL_BRICK_Z);
    const size_t at = 4 * (((size_t)(z + slice) * grid->size_y + y + row) * grid->size_x + x + column);
    store_samples(s.irradiance.x, s.irradiance.y, s.irradiance.z, s.lights, irradiance + at,
                  4 * grid->size_x);
    store_samples(s.directions.x, s.directions.y, s.directions.z, s.weight, directions + at,
                  4 * grid->size_x);
  }
}
