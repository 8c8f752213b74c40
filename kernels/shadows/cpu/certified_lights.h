// What certificates say of the pieces of a tile and up to 16 lights of its list at once.
#pragma once

#include "kernels/shadows/cpu/few_triangles.h"
#include "kernels/shadows/cpu/kept_tiles.h"
#include "kernels/shadows/cpu/tile_pieces.h"

#define CERTIFICATE_AWAY 5u  // a kind: light and eye are on different sides of the piece

typedef struct LightBatch {
  uint entry[16], light[16];  // of the tile's list
  uint count;
  real x, y, z, reach;
  uint16 stamp;
  uint points;  // lanes of lights at a point
  uint16 states[MOST_PIECES];
} LightBatch;

static inline void set_lanes(LightBatch* b, global const ShadowLight* lights) {
  b->points = 0;
  for (uint i = 0; i < 16; ++i) {
    global const ShadowLight* l = lights + b->light[min(i, b->count - 1)];
    ((float*)&b->x)[i] = (float)l->x, ((float*)&b->y)[i] = (float)l->y, ((float*)&b->z)[i] = (float)l->z;
    ((float*)&b->reach)[i] = sqrt(l->reach_squared), ((uint*)&b->stamp)[i] = l->stamp;
    if (i < b->count && l->w != 0) b->points |= 1u << i;
  }
}

// Lanes of lights on the other side of a piece's triangle than the eye.
static inline uint lights_away(const LightBatch* b, const TilePiece* p, uint lanes,
                               global const ShadowLight* lights) {
  global const RayTriangle* t = p->plane;
  const float x = t->corners[0], y = t->corners[1], z = t->corners[2];
  const real side = (b->x - x) * (float)t->normal[0] + (b->y - y) * (float)t->normal[1] +
                    (b->z - z) * (float)t->normal[2],
             slack = 0x1p-20f * (fabs(b->x) + fabs(b->y) + fabs(b->z) + (fabs(x) + fabs(y) + fabs(z)));
  uint above = lane_bits(side > slack), below = lane_bits(side < -slack);
  for (uint unsure = lanes & ~(above | below); unsure != 0; unsure &= unsure - 1) {
    const uint lane = lowest_bit(unsure);
    global const ShadowLight* l = lights + b->light[lane];
    const double exact = plane_distance(t, l->x, l->y, l->z, 1);
    if (exact > 0) above |= 1u << lane;
    if (exact < 0) below |= 1u << lane;
  }
  return lanes & (p->eye == 2 ? below : p->eye == 0 ? above : 0u);
}

// The certificate of one light, made now. One that could not be kept costs more than rays.
static __attribute__((noinline)) uint missing_state(const RayScene* scene, const TilePiece* p,
                                                    PieceCertificates* kept, global const ShadowLight* l,
                                                    const Certificates* c) {
  if (unused_light_of(c, p->certificates) == CERTIFICATE_LIGHTS) return CERTIFICATE_UNDECIDED;
  int places[CERTIFICATE_PLACES];
  const uint state = make_certificate(scene, &p->piece, l, places), first = kept->place_count,
             count = places_of(state);
  keep_certificate(c, p->certificates, &p->piece, l->stamp, state, places);
  if (first + count > CERTIFICATE_POOL) return CERTIFICATE_UNDECIDED;
  for (uint k = 0; k < count; ++k) kept->places[first + k] = places[k];
  kept->place_count += count;
  return state | first << CERTIFICATE_FIRST_SHIFT;
}

// Of a piece and each light: what is known. CERTIFICATE_NONE: out of range.
static inline uint16 states_of_piece(const RayScene* scene, const TilePiece* p, PieceCertificates* kept,
                                     const LightBatch* b, global const ShadowLight* lights,
                                     const Certificates* c) {
  const real dx = b->x - p->x, dy = b->y - p->y, dz = b->z - p->z, far = b->reach + p->radius;
  const uint near = b->points & lane_bits(dx * dx + dy * dy + dz * dz <= far * far * 1.00001f);
  const uint16 undecided = (uint16)(CERTIFICATE_UNDECIDED);
  uint16 states = lanes_of(~b->points) ? undecided : (uint16)(CERTIFICATE_NONE);
  if (near == 0) return states;
  const uint away = lights_away(b, p, near, lights);
  uint left = near & ~away;
  states = lanes_of(away) ? (uint16)(CERTIFICATE_AWAY) : states;
  if (!p->certificates) return lanes_of(left) ? undecided : states;
  for (uint i = 0; i < CERTIFICATE_LIGHTS && left != 0 && kept->stamps[i] != 0; ++i) {
    const uint here = left & lane_bits(b->stamp == (uint16)(kept->stamps[i]));
    if (here == 0) continue;
    states = lanes_of(here) ? (uint16)(kept->states[i]) : states;
    left &= ~here;
    if (((uchar*)kept->light_used)[i] != (uchar)c->time) *light_used(p->certificates, i) = c->time;
  }
  for (; left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    ((uint*)&states)[lane] = missing_state(scene, p, kept, lights + b->light[lane], c);
  }
  return states;
}

// Adds the pixels that are hidden from a light of the batch by what certificates say. `left`: pixels that
// take rays. *decided is increased by the number of the others that are not out of range.
static void hidden_by_certificates(const RayScene* scene, const TilePieces* pieces,
                                   const Receivers* receivers, TileSegments* segments, const LightBatch* b,
                                   uint lane, global const ShadowLight* l, uint words[SHADOW_WORDS],
                                   uint left[SHADOW_WORDS], uint* decided) {
  for (uint i = 0; i < pieces->count; ++i) {
    const uint state = ((const uint*)(b->states + i))[lane], kind = state & CERTIFICATE_KIND;
    const TilePiece* p = pieces->of + i;
    if (kind == CERTIFICATE_NONE) continue;
    if (kind == CERTIFICATE_UNDECIDED) {
      for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] |= p->words[w];
      continue;
    }
    *decided += p->pixels;
    if (kind == CERTIFICATE_FREE) continue;
    const bool reached = state & CERTIFICATE_REACHED;
    if (kind == CERTIFICATE_HIDDEN && reached) {
      for (uint w = 0; w < SHADOW_WORDS; ++w) words[w] |= p->words[w];
      continue;
    }
    ushort lanes[16];
    uint some = 0;  // blocks
    for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1) {
      const uint block = lowest_bit(blocks);
      uint here = lanes_of_block(p->words, block);
      if (!reached) here &= reached_of(segments, receivers + block, block, l);
      if (here == 0) continue;
      if (kind != CERTIFICATE_FEW) {
        words[block / 2] |= here << 16 * (block & 1u);
        continue;
      }
      some |= 1u << block, lanes[block] = here;
      set_segments(segments, receivers + block, block, l);
    }
    if (some != 0) {
      hidden_by_few(scene, receivers, l, segments, some, lanes, pieces->kept[i].places + first_place(state),
                    places_of(state), words);
    }
  }
}

// The bits of the batch's lights.
static void hidden_from_batch(const RayScene* scene, TilePieces* pieces, const Receivers* receivers,
                              LightBatch* b, global const ShadowLight* lights, const Certificates* c,
                              constant ShadowView* v, global uint* bits, global KeptShadow* next_shadows,
                              uint* decided, uint* traced, int* last_blocker) {
  set_lanes(b, lights);
  for (uint i = 0; i < pieces->count; ++i)
    b->states[i] = states_of_piece(scene, pieces->of + i, pieces->kept + i, b, lights, c);
  for (uint lane = 0; lane < b->count; ++lane) {
    global const ShadowLight* l = lights + b->light[lane];
    uint words[SHADOW_WORDS] = {0}, left[SHADOW_WORDS];
    for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] = pieces->others[w];
    TileSegments segments;
    segments.ready = segments.ready_reached = 0;
    hidden_by_certificates(scene, pieces, receivers, &segments, b, lane, l, words, left, decided);
    hidden_by_rays(scene, receivers, &segments, left, l, v, words, traced, last_blocker);
    keep_shadow(bits, next_shadows, b->entry[lane], b->light[lane], l->stamp, vload8(0, words));
  }
  b->count = 0;
}
