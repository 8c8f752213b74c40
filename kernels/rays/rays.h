// Any-hit shadow rays: which segments from a light to LANES points meet a triangle of a RayScene
// (rays/ray_scene.h). 16 points share a light; 1 on GPUs. The same bits in both forms and on every device
// with cl_khr_fp64 that rounds divisions correctly. docs/rays.md has the contract and the arithmetic.
//
//   kernel void find(RAYS_ARGUMENTS, ...) {   // built with RayScene::defines(), RayScene::arguments() first
//     const RayScene scene = RAYS_SCENE;
//     int last_blocker = -1;                  // carried from call to call
//     hidden = rays_hidden(&scene, light, to, gap, active, own, &last_blocker);
//   }
#pragma once

#include "kernels/rays/ray_packet.h"
#include "shared/surface_records.h"

#ifdef RAYS_MASKS
#include "kernels/rays/ray_masks.h"
#endif

#define RAYS_ARGUMENTS                                                                                     \
  global const RayNode *ray_nodes, global const RayTriangle *ray_triangles, global const uint *ray_places, \
      float ray_extent, global const uint4 *ray_masks, global const SurfaceVertex *ray_vertices,           \
      global const SurfaceMaterial *ray_materials, global const uint *ray_alphas
#ifdef RAYS_MASKS
#define RAYS_MASK_SOURCE                                                   \
  , {                                                                      \
    ray_masks, { ray_vertices, ray_materials, ray_alphas, (float2)(0.0f) } \
  }
#else
#define RAYS_MASK_SOURCE
#endif
#define RAYS_SCENE \
  { ray_nodes, ray_triangles, ray_places, ray_extent RAYS_MASK_SOURCE }

typedef struct RayScene {
  global const RayNode* nodes;
  global const RayTriangle* triangles;  // in the order of the tree, then those that cast nothing
  global const uint* places;            // a triangle's number to its place in `triangles`
  float extent;                         // no coordinate is greater
#ifdef RAYS_MASKS
  RayMasks masks;
#endif
} RayScene;

// Relative to the scene's origin, x y z of each.
static inline void rays_triangle(const RayScene* scene, uint number, float corners[9]) {
  global const float* from = scene->triangles[scene->places[number]].corners;
  for (int i = 0; i < 9; ++i) corners[i] = from[i];
}

// Tests one triangle. Lanes that it hides are added to `hidden` and take no further part; true: none is left.
static inline bool ray_blocked(const RayScene* scene, RayPacket* p, int place, whole own, uint live,
                               mask_t* hidden) {
  global const RayTriangle* t = scene->triangles + place;
  RayWeights weights;
  mask_t met = meets_triangle(p, t, &weights);
  if (!any_lane(met)) return false;
  met &= meets_own_box(p, t->corners) & (own != (whole)((int)(t->number & ~RAY_MASKED)));
#ifdef RAYS_MASKS
  if (t->number & RAY_MASKED)
    met &= hides_by_mask(&scene->masks, place, weights.first, weights.second, weights.third);
#endif
  *hidden |= met;
  p->end = met ? REAL(-1.0f) : p->end;
  return lane_bits(*hidden) == live;
}

// Lanes of `active` whose segment from the light to `to`, less its last `gap` metres, meets a triangle other
// than number `own` (below 0: any). `to` is relative to the scene's origin. The triangle that hid a lane last
// is tried first: *last_blocker, which is -1 at first, and does not change the answer.
static inline mask_t rays_hidden(const RayScene* scene, RaySource light, Real3 to, real gap, mask_t active,
                                 whole own, int* last_blocker) {
  const uint live = lane_bits(active);
  mask_t hidden = (mask_t)(0);
  if (live == 0) return hidden;
  RayPacket p = ray_packet(light, to, gap, active, scene->extent);
  if (*last_blocker >= 0 && ray_blocked(scene, &p, *last_blocker, own, live, &hidden)) return hidden;
  int stack[RAY_STACK], height = 0, at = 0;
  for (;;) {
    global const RayNode* n = scene->nodes + at;
    const uint met[2] = {lane_bits(meets_box(&p, n->low_0[0], n->low_0[1], n->low_0[2], n->high_0[0],
                                             n->high_0[1], n->high_0[2])),
                         lane_bits(meets_box(&p, n->low_1[0], n->low_1[1], n->low_1[2], n->high_1[0],
                                             n->high_1[1], n->high_1[2]))};
    const int child[2] = {n->child_0, n->child_1}, count[2] = {n->count_0, n->count_1};
    int next[2], nexts = 0;
    for (int side = 0; side < 2; ++side) {
      if (met[side] == 0) continue;
      if (count[side] == 0) next[nexts++] = child[side];
      for (int i = child[side]; i < child[side] + count[side]; ++i) {
        const uint before = lane_bits(hidden);
        const bool all = ray_blocked(scene, &p, i, own, live, &hidden);
        if (lane_bits(hidden) != before) *last_blocker = i;
        if (all) return hidden;
      }
    }
    if (nexts == 2) stack[height++] = next[1];
    if (nexts == 0 && height == 0) return hidden;
    at = nexts == 0 ? stack[--height] : next[0];
  }
}
