// Which points lie in the shadow of a light, for GPUs: a work-item a point. Arguments and bytes as
// kernels/rays/cpu/occlusion.cl has them.
#include "kernels/rays/rays.h"

#define GROUP 64

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void occlusion(
    RAYS_ARGUMENTS, global const float* points, global const int* own, global const RaySource* lights,
    global const uint4* packets, uint count, uint a_work_item, global uint* hidden) {
  local volatile uint bits[GROUP / 16];
  const RayScene scene = RAYS_SCENE;
  const uint item = (uint)get_local_id(0), lane = item % 16, in_group = item / 16;
  int last_blocker = -1;
  for (uint i = 0; i < a_work_item; ++i) {
    const uint number = ((uint)get_group_id(0) * a_work_item + i) * (GROUP / 16) + in_group;
    if (lane == 0) bits[in_group] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (number < count) {
      const uint4 packet = packets[number];
      global const float* at = points + packet.x * (size_t)64 + lane;
      if (rays_hidden(&scene, lights[packet.y], real3(at[0], at[16], at[32]), at[48], packet.z >> lane & 1,
                      own[packet.x * 16 + lane], &last_blocker)) {
        atomic_or(&bits[in_group], 1u << lane);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0 && number < count) hidden[number] = bits[in_group];
  }
}
