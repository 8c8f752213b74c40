// What shadow maps answer at points, a work-item a packet of 16 points that share a light.
//
// RAYS_ARGUMENTS         the triangles that the points lie on
// SHADOW_MAPS_ARGUMENTS  the maps
// points   float4 each: relative to the scene's origin, and the gap (metres)
// own      uint a point: the triangle that it lies on
// packets  uint4 each: block of 16 points, light, a bit for each point that is meant, 0
// taps     uchar a point of a packet: how many of the taps are hidden
#include "kernels/rays/rays.h"
#include "kernels/shadow_maps/shadow_maps.h"

kernel void look_up(RAYS_ARGUMENTS, SHADOW_MAPS_ARGUMENTS, global const float4* points, global const uint* own,
                    global const uint4* packets, global uchar* taps) {
  const RayScene scene = RAYS_SCENE;
  const ShadowMaps maps = SHADOW_MAPS;
  const size_t packet = get_global_id(0);
  const uint4 p = packets[packet];
  for (uint lane = 0; lane < 16; ++lane) {
    uint hidden = 0;
    if (p.z >> lane & 1) {
      const size_t i = p.x * (size_t)16 + lane;
      float corners[9];
      rays_triangle(&scene, own[i], corners);
      hidden = shadow_taps(&maps, p.y, points[i].xyz, corners, points[i].w);
    }
    taps[packet * 16 + lane] = (uchar)hidden;
  }
}
