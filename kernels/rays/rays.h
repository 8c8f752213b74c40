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

#include "kernels/common/fetch.h"
#include "kernels/rays/ray_packet.h"
#include "shared/surface_records.h"

#ifdef RAYS_MASKS
#include "kernels/rays/ray_masks.h"
#endif

#define RAYS_ARGUMENTS                                                                                     \
  global const RayNode *ray_nodes, global const RayTriangle *ray_triangles, global const uint *ray_places, \
      global const RayWideNode *ray_wide_nodes, global const uint4 *ray_masks,                             \
      global const SurfaceVertex *ray_vertices, global const SurfaceMaterial *ray_materials,               \
      global const uint *ray_alphas
#ifdef RAYS_MASKS
#define RAYS_MASK_SOURCE                                                   \
  , {                                                                      \
    ray_masks, { ray_vertices, ray_materials, ray_alphas, (float2)(0.0f) } \
  }
#else
#define RAYS_MASK_SOURCE
#endif
#define RAYS_SCENE \
  { ray_nodes, ray_triangles, ray_places, ray_wide_nodes RAYS_MASK_SOURCE }

typedef struct RayScene {
  global const RayNode* nodes;
  global const RayTriangle* triangles;   // in the order of the tree, then those that cast nothing
  global const uint* places;             // a triangle's number to its place in `triangles`
  global const RayWideNode* wide_nodes;  // with -DRAYS_WIDE
#ifdef RAYS_MASKS
  RayMasks masks;
#endif
} RayScene;

// Relative to the scene's origin, x y z of each.
static inline void rays_triangle(const RayScene* scene, uint number, float corners[9]) {
  global const float* from = scene->triangles[scene->places[number]].corners;
  for (int i = 0; i < 9; ++i) corners[i] = from[i];
}

#ifdef RAYS_VEILS
#define IN_MEMORY RayPacket
#else
#define IN_MEMORY const RayPacket
#endif

// The lanes that the triangle hides among those that meet it. A blended one hides none, but adds to veils.
RAYS_CALL mask_t ray_hides(const RayScene* scene, IN_MEMORY* p, int place, whole own, mask_t met) {
  global const RayTriangle* t = scene->triangles + place;
  met &= meets_own_box(p, t->corners) & (own != (whole)((int)(t->number & ~RAY_MASKED)));
#ifdef RAYS_MASKS
  if (t->number & RAY_MASKED && any_lane(met)) {
    Real3 weights;
    meets_triangle(p->light, p->light.w != 0, t, real3(p->x, p->y, p->z), p->end, &weights);
#ifdef RAYS_VEILS
    if (scene->masks.of_place[place].x & RAY_BLENDS) {
      const whole veil = veil_of(alpha_of_hit(&scene->masks, place, weights.x, weights.y, weights.z));
      p->veil = min(p->veil + (met ? veil : (whole)(0)), (whole)(MOST_VEIL));
      return (mask_t)(0);
    }
#endif
    met &= hides_by_mask(&scene->masks, place, weights.x, weights.y, weights.z);
  }
#endif
  return met;
}

// Tests one triangle. Lanes that it hides are added to `hidden` and take no further part; true: there are
// some.
static inline __attribute__((always_inline)) bool ray_met(const RayScene* scene, RayPacket* p,
                                                          const bool point, int place, whole own,
                                                          mask_t* hidden) {
  global const RayTriangle* t = scene->triangles + place;
  const Real3 at = real3(p->x, p->y, p->z);
  mask_t met = point ? meets_from_point(p->light.x, p->light.y, p->light.z, t, at, p->end)
                     : meets_from_direction(p->light.x, p->light.y, p->light.z, t, at, p->end);
  if (!any_lane(met)) return false;
  IN_MEMORY in_memory = *p;
  met = ray_hides(scene, &in_memory, place, own, met);
#ifdef RAYS_VEILS
  p->veil = in_memory.veil;
#endif
  *hidden |= met;
  p->end = met ? REAL(-1.0f) : p->end;
  return any_lane(met);
}

// The triangles of a leaf. True: no lane is left.
static inline __attribute__((always_inline)) bool leaf_blocked(const RayScene* scene, RayPacket* p,
                                                               const bool point, int first, int count,
                                                               whole own, uint live, mask_t* hidden,
                                                               int* last_blocker) {
  for (int i = first; i < first + count; ++i) {
    if (!ray_met(scene, p, point, i, own, hidden)) continue;
    *last_blocker = i;
    if (lane_bits(*hidden) == live) return true;
  }
  return false;
}

#if defined(RAYS_WIDE) && LANES == 16
#include "kernels/rays/wide_walk.h"
#else
static inline void fetch_child(const RayScene* scene, int child, int count) {
  if (count == 0)
    FETCH(scene->nodes + child);
  else
    FETCH(scene->triangles + child);
}

// Walks the tree for the lanes that trace() names.
static inline __attribute__((always_inline)) void walk_tree(const RayScene* scene, RayPacket* p,
                                                            const bool point, whole own, uint live,
                                                            mask_t* hidden, int* last_blocker) {
  // A node is 12 floats: indices of the planes where segments enter the first box and where they leave it.
  const int in_x = p->down & 1 ? 3 : 0, in_y = p->down & 2 ? 4 : 1, in_z = p->down & 4 ? 5 : 2;
  const int out_x = 3 - in_x, out_y = 5 - in_y, out_z = 7 - in_z;
  int stack[RAY_STACK], height = 0, at = 0;
  for (;;) {
    global const RayNode* n = scene->nodes + at;
    global const float* f = n->low_0;
    fetch_child(scene, n->child_0, n->count_0);
    fetch_child(scene, n->child_1, n->count_1);
    // Used at once, or the compiler keeps what the second test needs until the first leaf is done.
    uint met = lane_bits(meets_box(p, f[in_x], f[in_y], f[in_z], f[out_x], f[out_y], f[out_z])) |
               lane_bits(meets_box(p, f[in_x + 6], f[in_y + 6], f[in_z + 6], f[out_x + 6], f[out_y + 6],
                                   f[out_z + 6]))
                   << 16;
    if (met == 0) {
      if (height == 0) return;
      at = stack[--height];
      continue;
    }
    bool go_0 = (met & 0xffffu) != 0, go_1 = met >> 16 != 0;
    if (go_0 && n->count_0 != 0) {
      go_0 = false;
      if (leaf_blocked(scene, p, point, n->child_0, n->count_0, own, live, hidden, last_blocker)) return;
    }
    if (go_1 && n->count_1 != 0) {
      go_1 = false;
      if (leaf_blocked(scene, p, point, n->child_1, n->count_1, own, live, hidden, last_blocker)) return;
    }
    if (go_0) {
      at = n->child_0;
      if (go_1) stack[height++] = n->child_1;
    } else if (go_1) {
      at = n->child_1;
    } else if (height != 0) {
      at = stack[--height];
    } else {
      return;
    }
  }
}
#endif

// Returns which of the lanes `live` are hidden. Their segments go the same way along each axis.
static inline __attribute__((always_inline)) mask_t trace(const RayScene* scene, RayPacket* p,
                                                          const bool point, whole own, uint live,
                                                          int* last_blocker) {
  mask_t hidden = (mask_t)(0);
  if (*last_blocker >= 0 && ray_met(scene, p, point, *last_blocker, own, &hidden) &&
      lane_bits(hidden) == live)
    return hidden;
  walk_tree(scene, p, point, own, live, &hidden, last_blocker);
  return hidden;
}

// Which way each lane's segment goes along each axis.
typedef struct RayOctants {
  real end;
  uint down_x, down_y, down_z;
} RayOctants;

static inline RayOctants octants_of(const RayPacket* p) {
  const RayOctants o = {p->end, lane_bits(p->inverse_x < 0.0f), lane_bits(p->inverse_y < 0.0f),
                        lane_bits(p->inverse_z < 0.0f)};
  return o;
}

// Takes the lanes of `left` that go the same way as the first: the packet then consists of them.
static inline uint take_octant(RayPacket* p, const RayOctants* o, uint left) {
  const uint lane = lowest_bit(left);
  p->down = (o->down_x >> lane & 1) | (o->down_y >> lane & 1) << 1 | (o->down_z >> lane & 1) << 2;
  const uint live = left & (p->down & 1 ? o->down_x : ~o->down_x) & (p->down & 2 ? o->down_y : ~o->down_y) &
                    (p->down & 4 ? o->down_z : ~o->down_z);
  p->end = lanes_of(live) ? o->end : REAL(-1.0f);
  return live;
}

// Lanes of `active` whose segment from the light to `to`, less its last `gap` metres, meets a triangle other
// than number `own` (below 0: any). `to` is relative to the scene's origin. The triangle that hid a lane last
// is tried first: *last_blocker, which is -1 at first, and does not change the answer. *veil: of lanes that
// are not hidden, that of blended triangles; unchanged without -DRAYS_VEILS.
static inline mask_t rays_veiled(const RayScene* scene, RaySource light, Real3 to, real gap, mask_t active,
                                 whole own, int* last_blocker, whole* veil) {
  mask_t hidden = (mask_t)(0);
  uint left = lane_bits(active);
  if (left == 0) return hidden;
  RayPacket p;
  set_packet(&p, light, to, gap);
#ifdef RAYS_VEILS
  p.veil = (whole)(0);
#endif
  const RayOctants octants = octants_of(&p);
  while (left != 0) {  // mostly once
    const uint live = take_octant(&p, &octants, left);
    left &= ~live;
    hidden |= light.w != 0 ? trace(scene, &p, true, own, live, last_blocker)
                           : trace(scene, &p, false, own, live, last_blocker);
  }
#ifdef RAYS_VEILS
  *veil = p.veil;
#endif
  return hidden;
}

// The same without blended triangles, which hide nothing then.
static inline mask_t rays_hidden(const RayScene* scene, RaySource light, Real3 to, real gap, mask_t active,
                                 whole own, int* last_blocker) {
  whole veil = (whole)(0);
  return rays_veiled(scene, light, to, gap, active, own, last_blocker, &veil);
}

// 255ths of the light that are hidden from each lane: 0 or 255 without blended triangles.
static inline whole hidden_255ths(mask_t hidden, whole veil) {
#ifdef RAYS_VEILS
  return hidden ? (whole)(255) : share_of_veil(veil);
#else
  return hidden ? (whole)(255) : (whole)(0);
#endif
}

static inline whole rays_share(const RayScene* scene, RaySource light, Real3 to, real gap, mask_t active,
                               whole own, int* last_blocker) {
  whole veil = (whole)(0);
  const mask_t hidden = rays_veiled(scene, light, to, gap, active, own, last_blocker, &veil);
  return hidden_255ths(hidden, veil);
}
