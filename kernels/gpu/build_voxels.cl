// Fills a voxel light buffer, for GPUs: a work-group takes a block of samples, a work-item one of them. As
// cpu/build_voxels.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/common/voxel_light.h"

#define ITEMS (VOXEL_GROUP_X * VOXEL_GROUP_Y * VOXEL_GROUP_Z)
#define WORDS (ITEMS / 32)

// How many of the words' bits come before an item's, and how many there are.
static inline uint2 count_flags(local const uint* words, uint item) {
  uint before = popcount(words[item / 32] & ((1u << item % 32) - 1u)), all = 0;
  for (uint w = 0; w < WORDS; ++w) {
    const uint bits = popcount(words[w]);
    before += w < item / 32 ? bits : 0;
    all += bits;
  }
  return (uint2)(before, all);
}

// The bits of `flag` of all work-items, in words that all of them read afterwards.
static inline void gather_flags(local uint* words, uint item, bool flag) {
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < WORDS) words[item] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (flag) atomic_or(words + item / 32, 1u << item % 32);
  barrier(CLK_LOCAL_MEM_FENCE);
}

kernel __attribute__((reqd_work_group_size(VOXEL_GROUP_X, VOXEL_GROUP_Y, VOXEL_GROUP_Z))) void build_voxels(
    global const float* boxes, global const float* places, global const float4* colors,
    global const float8* cones, constant VoxelGrid* grid, constant VoxelSlice* slices,
    global voxel_t* irradiance, global voxel_t* directions) {
  local uint words[WORDS], groups[ITEMS];
  // Lights that may reach the block, in order: places and radii, numbers, and their reach in each of the
  // block's slices, whose division and root would else be each sample's.
  local float4 kept[ITEMS];
  local uint numbers[ITEMS];
  local VoxelReach reaches[ITEMS * VOXEL_GROUP_Z];
  const uint ix = get_global_id(0), iy = get_global_id(1), iz = get_global_id(2);
  const uint z = iz / VOXEL_GROUP_Z * VOXEL_GROUP_Z;
  const uint item = (get_local_id(2) * VOXEL_GROUP_Y + get_local_id(1)) * VOXEL_GROUP_X + get_local_id(0);
#ifdef SPOTS
  const VoxelLights lights = {boxes, places, colors, cones};
#else
  const VoxelLights lights = {boxes, places, colors};
#endif
  const VoxelBox box =
      box_of_samples(grid, slices, ix / VOXEL_GROUP_X * VOXEL_GROUP_X, iy / VOXEL_GROUP_Y * VOXEL_GROUP_Y, z,
                     VOXEL_GROUP_X, VOXEL_GROUP_Y, VOXEL_GROUP_Z);
  const float grown = grown_by(slices, z, VOXEL_GROUP_Z);
  Real3 position = real3(grid->origin_x + (float)ix * grid->spacing_x,
                         grid->origin_y + (float)iy * grid->spacing_y, slices[iz].place);
#ifdef VOXELS_LOG
  position = real3(position.x * position.z, position.y * position.z, -position.z);
#endif
  VoxelSum sum = {{0}};
  for (uint first = 0; first < grid->groups; first += ITEMS) {
    // The groups that meet the block, in order.
    const uint group = first + item;
    bool meets = false;
    if (group < grid->groups) {
      global const float* b = boxes + group / 16 * 96 + group % 16;
      meets = may_meet(b[0], b[16], b[32], b[48], b[64], b[80], &box, grown);
    }
    gather_flags(words, item, meets);
    const uint2 of_groups = count_flags(words, item);
    const uint met = of_groups.y;
    if (meets) groups[of_groups.x] = group;
    barrier(CLK_LOCAL_MEM_FENCE);
    // Their lights, ITEMS at once.
    for (uint batch = 0; batch < met; batch += ITEMS / VOXEL_LIGHT_GROUP) {
      const uint mine = batch + item / VOXEL_LIGHT_GROUP;
      float4 light = (float4)(0.0f);
      bool may_reach = false;
      if (mine < met) {
        global const float* at = places + groups[mine] * (4 * VOXEL_LIGHT_GROUP) + item % VOXEL_LIGHT_GROUP;
        light = (float4)(at[0], at[VOXEL_LIGHT_GROUP], at[2 * VOXEL_LIGHT_GROUP], at[3 * VOXEL_LIGHT_GROUP]);
        may_reach = may_light(light.x, light.y, light.z, light.w, &box, grown);
      }
      gather_flags(words, item, may_reach);
      const uint2 of_lights = count_flags(words, item);
      if (may_reach) {
        kept[of_lights.x] = light;
        numbers[of_lights.x] = groups[mine] * VOXEL_LIGHT_GROUP + item % VOXEL_LIGHT_GROUP;
      }
      barrier(CLK_LOCAL_MEM_FENCE);
      for (uint i = item; i < of_lights.y * VOXEL_GROUP_Z; i += ITEMS)
        reaches[i] = voxel_reach(kept[i / VOXEL_GROUP_Z].w, slices + z + i % VOXEL_GROUP_Z);
      barrier(CLK_LOCAL_MEM_FENCE);
      for (uint i = 0; i < of_lights.y; ++i) {
        add_voxel_light(&sum, position, slices + iz, kept[i].xyz, reaches[i * VOXEL_GROUP_Z + (iz - z)],
                        &lights, numbers[i]);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  const VoxelSum s = as_stored(sum, grid);
  const size_t at = 4 * (((size_t)iz * grid->size_y + iy) * grid->size_x + ix);
  STORE_VOXEL(((float4)(s.irradiance.x, s.irradiance.y, s.irradiance.z, s.lights)), irradiance + at);
  STORE_VOXEL(((float4)(s.directions.x, s.directions.y, s.directions.z, s.weight)), directions + at);
}
