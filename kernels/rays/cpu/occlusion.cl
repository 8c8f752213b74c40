// Which points lie in the shadow of a light, for CPUs: packets of 16 points that share a light.
//
// RAYS_ARGUMENTS  the scene
// points   blocks of 16 points, relative to the scene's origin: 16 x, 16 y, 16 z, 16 gaps (metres)
// own      int a point: the triangle that it lies on, or -1
// lights   RaySource each
// packets  uint4 each: block, light, a bit for each point that is meant, 0
// hidden   uint a packet: a bit for each of these that is hidden
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/rays/rays.h"

kernel ONE_ITEM void occlusion(RAYS_ARGUMENTS, global const float* points, global const int* own,
                               global const RaySource* lights, global const uint4* packets, uint count,
                               uint a_work_item, global uint* hidden) {
  ASSUME_ONE_ITEM;
  const RayScene scene = RAYS_SCENE;
  const uint first = (uint)get_global_id(0) * a_work_item, end = min(first + a_work_item, count);
  int last_blocker = -1;
  for (uint i = first; i < end; ++i) {
    const uint4 packet = packets[i];
    global const float* at = points + packet.x * (size_t)64;
    const Real3 to = real3(vload16(0, at), vload16(1, at), vload16(2, at));
    const mask_t active = ((int16)((int)packet.z) >> LANE_INDEX & 1) != 0;
    hidden[i] = lane_bits(rays_hidden(&scene, lights[packet.y], to, vload16(3, at), active,
                                      vload16(packet.x, own), &last_blocker));
  }
}
