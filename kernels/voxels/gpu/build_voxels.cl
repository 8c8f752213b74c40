// Fills a voxel light buffer, for GPUs: a work-group takes 8 x 4 samples of a slice. As
// voxels/cpu/build_voxels.cl, with the same arguments.
//
// The work-group that most lights reach takes longest, one light after another: a sample adds them in their
// order. So work-items compute what different lights bring to a sample side by side, and then add it up
// in that order, each a part of the sample's sums.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/voxels/voxel_light.h"

#define ITEMS VOXEL_GROUP_ITEMS
#define SAMPLES VOXEL_GROUP_SAMPLES
#define WORDS (ITEMS / 32)
#define CHUNK 16u  // lights between two sums
#if ITEMS < 3 * SAMPLES
#error "each sample needs a work-item for each part of its sums"
#endif
// Parts of the sums, one each SAMPLES work-items: those of further work-items stay unused.
#define IRRADIANCE 0u
#define DIRECTIONS 1u
#define WEIGHT 2u  // and the number of lights

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

// This bit of a light's number says that it has a cone, which few have.
#define WITH_CONE 0x80000000u

static inline uint marked_number(global const float8* cones, uint number) {
#ifdef SPOTS
  return cones[number].s4 != 0.0f ? number | WITH_CONE : number;
#else
  return number;
#endif
}

static inline float8 marked_cone(global const float8* cones, uint marked) {
#ifdef SPOTS
  if (marked & WITH_CONE) return cones[marked & ~WITH_CONE];
#endif
  return (float8)(0.0f);
}

// The numbers that a light adds to a part of a sample's sums. brought: its attenuation, and its weight over
// distance. Zeros where it does not reach: they leave a sum as it is.
static inline float4 added_part(uint part, float2 brought, float4 place, float4 color, Real3 position) {
  const Real3 arrives = voxel_irradiance(brought.x, color);
  float4 added = (float4)(arrives.x, arrives.y, arrives.z, 0.0f);
  if (part == DIRECTIONS) {
    added = (float4)(brought.y * (place.x - position.x), brought.y * (place.y - position.y),
                     brought.y * (place.z - position.z), 0.0f);
  } else if (part == WEIGHT) {
    added = (float4)(luminance_of(arrives), 1.0f, 0.0f, 0.0f);
  }
  return brought.x > 0.0f ? added : (float4)(0.0f);
}

kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void build_voxels(
    global const float* boxes, global const float* places, global const float4* colors,
    global const float8* cones, constant VoxelGrid* grid, constant VoxelSlice* slices,
    global voxel_t* irradiance, global voxel_t* directions) {
  local uint words[WORDS], groups[ITEMS];
  // Lights that may reach the samples, in order: places and radii, colours, reach in the slice, and numbers.
  local float4 kept[ITEMS], kept_colors[ITEMS];
  local VoxelReach reaches[ITEMS];
  local uint numbers[ITEMS];
  local float2 brought[CHUNK * SAMPLES];
  local float4 sums[3 * SAMPLES];
  const uint item = get_local_id(0), sample = item % SAMPLES, part = item / SAMPLES;
  const uint x = get_group_id(0) * VOXEL_GROUP_X, y = get_group_id(1) * VOXEL_GROUP_Y, z = get_group_id(2);
  const uint ix = x + sample % VOXEL_GROUP_X, iy = y + sample / VOXEL_GROUP_X;
  constant VoxelSlice* slice = slices + z;
  const VoxelBox box = box_of_samples(grid, slices, x, y, z, VOXEL_GROUP_X, VOXEL_GROUP_Y, 1);
  const float grown = slice->half_diagonal_squared;
  Real3 position = real3(grid->origin_x + (float)ix * grid->spacing_x,
                         grid->origin_y + (float)iy * grid->spacing_y, slice->place);
#ifdef VOXELS_LOG
  position = real3(position.x * position.z, position.y * position.z, -position.z);
#endif
  float4 sum = (float4)(0.0f);
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
        const uint number = groups[mine] * VOXEL_LIGHT_GROUP + item % VOXEL_LIGHT_GROUP;
        kept[of_lights.x] = light;
        kept_colors[of_lights.x] = colors[number];
        reaches[of_lights.x] = voxel_reach(light.w, slice);
        numbers[of_lights.x] = marked_number(cones, number);
      }
      barrier(CLK_LOCAL_MEM_FENCE);
      for (uint begin = 0; begin < of_lights.y; begin += CHUNK) {
        const uint count = min(CHUNK, of_lights.y - begin);
        for (uint i = part; i < count; i += ITEMS / SAMPLES) {
          const uint k = begin + i;
          const Real3 d = real3(kept[k].x - position.x, kept[k].y - position.y, kept[k].z - position.z);
          const float squared = dot3(d, d);
          float2 b = (float2)(0.0f);
          if (squared < reaches[k].squared) {
            const VoxelArrival a = voxel_arrival(position, kept[k].xyz, d, squared, slice, reaches[k],
                                                 kept_colors[k], marked_cone(cones, numbers[k]));
            b.x = a.attenuation;
            b.y = luminance_of(voxel_irradiance(a.attenuation, kept_colors[k])) * a.inverse;
          }
          brought[i * SAMPLES + sample] = b;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = 0; i < count && part <= WEIGHT; ++i)
          sum += added_part(part, brought[i * SAMPLES + sample], kept[begin + i], kept_colors[begin + i],
                            position);
        barrier(CLK_LOCAL_MEM_FENCE);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (part <= WEIGHT) sums[part * SAMPLES + sample] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (part > DIRECTIONS) return;
  const float4 e = sums[IRRADIANCE * SAMPLES + sample], d = sums[DIRECTIONS * SAMPLES + sample],
               w = sums[WEIGHT * SAMPLES + sample];
  const VoxelSum whole_sum = {{e.x, e.y, e.z}, {d.x, d.y, d.z}, w.x, w.y};
  const VoxelSum s = as_stored(whole_sum, grid);
  const size_t at = 4 * (((size_t)z * grid->size_y + iy) * grid->size_x + ix);
  if (part == IRRADIANCE) {
    STORE_VOXEL(((float4)(s.irradiance.x, s.irradiance.y, s.irradiance.z, s.lights)), irradiance + at);
  } else {
    STORE_VOXEL(((float4)(s.directions.x, s.directions.y, s.directions.z, s.weight)), directions + at);
  }
}
