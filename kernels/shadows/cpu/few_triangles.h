// Which of a tile's pixels are hidden from a light: by a few triangles, or by rays through the tree.
#pragma once

#include "kernels/shadows/receivers.h"

// From one light to the receivers of a tile's blocks: segments as set_packet has them, and what is in reach.
// Each is found when it is needed.
typedef struct TileSegments {
  Real3 to[16];
  real end[16];
  uint ready, ready_reached;  // blocks
  ushort reached[16];         // by the light, a bit a pixel
} TileSegments;

static inline uint lanes_of_block(const uint words[SHADOW_WORDS], uint block) {
  return words[block / 2] >> 16 * (block & 1u) & 0xffffu;
}

// may_shade of a block.
static inline uint reached_of(TileSegments* s, const Receivers* r, uint block, global const ShadowLight* l) {
  if (!(s->ready_reached >> block & 1u)) {
    s->ready_reached |= 1u << block;
    s->reached[block] = lane_bits(may_shade(r, l));
  }
  return s->reached[block];
}

static inline void set_segments(TileSegments* s, const Receivers* r, uint block,
                                global const ShadowLight* l) {
  if (s->ready >> block & 1u) return;
  s->ready |= 1u << block;
  RayPacket p;
  const RaySource source = {l->x, l->y, l->z, l->w};
  set_packet(&p, source, r->at, r->gap, 0.0f);
  s->to[block] = real3(p.x, p.y, p.z), s->end[block] = p.end;
}

// Of lanes that meet the triangle's planes, those that it hides: the rest of ray_met.
static __attribute__((noinline)) uint hidden_of_met(const RayScene* scene, const Receivers* r,
                                                    global const ShadowLight* l, int place, uint met) {
  RayPacket p;
  const RaySource source = {l->x, l->y, l->z, l->w};
  set_packet(&p, source, r->at, r->gap, scene->extent);
  const RayOctants octants = octants_of(&p);
  uint hidden = 0;
  while (met != 0) {  // mostly once
    const uint live = take_octant(&p, &octants, met);
    met &= ~live;
    hidden |= lane_bits(ray_hides(scene, &p, place, r->own, lanes_of(live)));
  }
  return hidden;
}

// Adds those of a piece's pixels (`left`, in `blocks`) that one of a few triangles hides: what rays_hidden
// gives without a tree. A triangle's planes, as meets_triangle has them, serve all blocks.
static __attribute__((noinline)) void hidden_by_few(const RayScene* scene, const Receivers* receivers,
                                                    global const ShadowLight* l, TileSegments* segments,
                                                    uint blocks, ushort left[16], const int* places,
                                                    uint count, uint words[SHADOW_WORDS]) {
  const RaySource source = {l->x, l->y, l->z, 1};
  for (uint i = 0; i < count && blocks != 0; ++i) {
    global const RayTriangle* t = scene->triangles + places[i];
    const double nx = t->normal[0], ny = t->normal[1], nz = t->normal[2];
    const double ax = t->corners[0] - l->x, ay = t->corners[1] - l->y, az = t->corners[2] - l->z;
    const double bx = t->corners[3] - l->x, by = t->corners[4] - l->y, bz = t->corners[5] - l->z;
    const double cx = t->corners[6] - l->x, cy = t->corners[7] - l->y, cz = t->corners[8] - l->z;
    const double distance = nx * ax + ny * ay + nz * az;
    if (!(distance > 0 || distance < 0)) continue;
    const double turn = distance < 0 ? -1 : 1;
    if (!((nx * bx + ny * by + nz * bz) * turn > 0 && (nx * cx + ny * cy + nz * cz) * turn > 0)) continue;
    const RayPlane a = edge_plane(source, true, bx, by, bz, cx, cy, cz),
                   b = edge_plane(source, true, cx, cy, cz, ax, ay, az),
                   c = edge_plane(source, true, ax, ay, az, bx, by, bz);
    const real offset = REAL((float)(-distance * turn));
    const float px = (float)(nx * turn), py = (float)(ny * turn), pz = (float)(nz * turn);
    for (uint now = blocks; now != 0; now &= now - 1) {
      const uint block = lowest_bit(now);
      const Real3 to = segments->to[block];
      const real end = segments->end[block];
      const real past = fma(end, ray_side(to, px, py, pz, 0.0f), offset),
                 edges = lane_min(lane_min(plane_side(to, a, turn), plane_side(to, b, turn)),
                                  plane_side(to, c, turn));
      const uint met = lane_bits(lane_min(lane_min(past, end), edges) >= 0.0f) & left[block];
      if (met == 0) continue;
      const uint hidden = hidden_of_met(scene, receivers + block, l, places[i], met);
      words[block / 2] |= hidden << 16 * (block & 1u);
      left[block] &= ~hidden;
      if (left[block] == 0) blocks &= ~(1u << block);
    }
  }
}

// Pixels of a tile that take rays to one light, from any of its blocks, so that packets are full.
typedef struct RayQueue {
  float x[32], y[32], z[32], gap[32];
  int own[32];
  uint pixel[32];  // as an entry numbers them
  uint count;
} RayQueue;

static inline void trace_queue(const RayScene* scene, RayQueue* q, global const ShadowLight* l,
                               uint words[SHADOW_WORDS], int* last_blocker) {
  const RaySource source = {l->x, l->y, l->z, l->w};
  const mask_t active = LANE_INDEX < (int16)((int)q->count);
  uint hidden =
      lane_bits(rays_hidden(scene, source, real3(vload16(0, q->x), vload16(0, q->y), vload16(0, q->z)),
                            vload16(0, q->gap), active, vload16(0, q->own), last_blocker));
  for (; hidden != 0; hidden &= hidden - 1) {
    const uint pixel = q->pixel[lowest_bit(hidden)];
    words[pixel / 32] |= 1u << (pixel & 31u);
  }
}

// After what certificates decide, the rest.
static void hidden_by_rays(const RayScene* scene, const Receivers* receivers, TileSegments* segments,
                           const uint left[SHADOW_WORDS], global const ShadowLight* l, constant ShadowView* v,
                           uint words[SHADOW_WORDS], uint* traced, int* last_blocker) {
  RayQueue q;
  q.count = 0;
  for (uint block = 0; block < 16; ++block) {
    const uint lanes = lanes_of_block(left, block);
    if (lanes == 0) continue;
    const Receivers* r = receivers + block;
    const uint here = reached_of(segments, r, block, l) & lanes;
    if (here == 0) continue;
    const mask_t reached = lanes_of(here);
    const mask_t away = turned_away(scene, r, l, reached, v);
    words[block / 2] |= lane_bits(away) << 16 * (block & 1u);
    uint rays = lane_bits(reached & ~away);
    *traced += popcount(rays);
    for (; rays != 0; rays &= rays - 1) {
      const uint lane = lowest_bit(rays), i = q.count++;
      q.x[i] = ((const float*)&r->at.x)[lane], q.y[i] = ((const float*)&r->at.y)[lane];
      q.z[i] = ((const float*)&r->at.z)[lane], q.gap[i] = ((const float*)&r->gap)[lane];
      q.own[i] = ((const int*)&r->own)[lane], q.pixel[i] = 16 * block + lane;
    }
    if (q.count < 16) continue;
    const uint rest = q.count - 16;
    q.count = 16;
    trace_queue(scene, &q, l, words, last_blocker);
    for (uint i = 0; i < rest; ++i) {
      q.x[i] = q.x[16 + i], q.y[i] = q.y[16 + i], q.z[i] = q.z[16 + i], q.gap[i] = q.gap[16 + i];
      q.own[i] = q.own[16 + i], q.pixel[i] = q.pixel[16 + i];
    }
    q.count = rest;
  }
  if (q.count != 0) trace_queue(scene, &q, l, words, last_blocker);
}
