// Looks up shadow maps at points: one work-item per packet of 16 points that share a light.
//
// RAYS_ARGUMENTS         the triangles that the points lie on
// SHADOW_MAPS_ARGUMENTS  the maps
// points   blocks of 16 points, relative to the scene's origin: 16 x, 16 y, 16 z, 16 gaps (metres)
// own      int a point: the triangle that it lies on
// packets  uint4 each: block, light, a bit for each point that is meant, 0
// taps     uchar a point of a packet: how many of the taps are hidden
#include "kernels/shadow_maps/shadow_maps.h"

kernel void look_up(RAYS_ARGUMENTS, SHADOW_MAPS_ARGUMENTS, global const float* points, global const int* own,
                    global const uint4* packets, global uchar* taps) {
  const RayScene scene = RAYS_SCENE;
  const ShadowMaps maps = SHADOW_MAPS;
  const size_t packet = get_global_id(0);
  const uint4 p = packets[packet];
  global const float* at = points + p.x * (size_t)64;
#if LANES == 16
  const mask_t active = lanes_of(p.z);
  const Real3 to = real3(vload16(0, at), vload16(1, at), vload16(2, at));
  const ShadowReceivers r = shadow_receivers(&scene, to, vload16(p.x, own), vload16(3, at), p.z);
  const whole hidden = shadow_taps(&maps, p.y, &r, active);
  vstore16(convert_uchar16(hidden), packet, taps);
#else
  for (uint lane = 0; lane < 16; ++lane) {
    uint hidden = 0;
    if (p.z >> lane & 1) {
      const Real3 to = real3(at[lane], at[16 + lane], at[32 + lane]);
      const ShadowReceivers r = shadow_receivers(&scene, to, own[p.x * (size_t)16 + lane], at[48 + lane], 1);
      hidden = (uint)shadow_taps(&maps, p.y, &r, 1);
    }
    taps[packet * 16 + lane] = (uchar)hidden;
  }
#endif
}
