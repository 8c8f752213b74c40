// The pieces of triangles that a tile shows, and what their certificates decide of a light.
#pragma once

#include "kernels/shadows/certificates.h"

#define MOST_PIECES 128
#define LEAST_PIXELS 4u   // of a piece in a tile: fewer take rays
#define LEAST_LIGHTS 2u   // of a tile, else grouping its pixels costs more than rays
#define SPLIT_PIXELS 24u  // of a piece that is not decided: with more, its eight parts are tried

typedef struct TilePiece {
  Piece piece;
  uint hash;
  float x, y, z, radius;  // a ball around its points
  global const RayTriangle* plane;
  uint eye;  // the eye's side of it, plus 1; 1 also where it lets light through
  uint pixels;
  uint blocks;               // that show it
  uint words[SHADOW_WORDS];  // its pixels, as an entry has them
  uint rest[SHADOW_WORDS];   // those in none of its parts
  uint parts, first_part;    // parts: NOT_SPLIT at first
} TilePiece;

#define NOT_SPLIT 0xffffffffu

typedef struct TilePieces {
  TilePiece of[MOST_PIECES];
  uint count;
  uint others[SHADOW_WORDS];  // pixels in no piece
  uint count_at_first;        // pieces that are no parts of others
} TilePieces;

// Lanes whose points belong to a piece: near its plane and its triangle, with all that these tests round.
static inline mask_t in_piece(const Receivers* r, global const RayTriangle* t, const Piece* piece) {
  const float edge = edge_of_piece(piece->exponent), off = off_plane(t, piece);
  if (!(off <= EDGE / 4 * edge)) return (mask_t)(0);
  mask_t in = r->slack <= off * 0.9999f;
  const int k = greatest_axis(t);
  const real at_u = k == 0   ? r->at.y
                    : k == 1 ? r->at.z
                             : r->at.x,
             at_v = k == 0   ? r->at.z
                    : k == 1 ? r->at.x
                             : r->at.y;
  const int u = (k + 1) % 3, v = (k + 2) % 3;
  const float turn = t->normal[k] < 0 ? -1.0f : 1.0f;
  for (uint i = 0; i < 3; ++i) {
    global const float *a = t->corners + 3 * i, *b = t->corners + 3 * ((i + 1) % 3);
    const float du = (b[u] - a[u]) * turn, dv = (b[v] - a[v]) * turn;
    const real x = at_u - a[u], y = at_v - a[v];
    const real inside = y * du - x * dv, slack = 0x1p-21f * (fabs(y) * fabs(du) + fabs(x) * fabs(dv));
    in &= inside - slack >= 1.25f * inner_edge(t, piece) * (fabs(du) + fabs(dv));
  }
  return in;
}

// One of those from `first` on, added if it is missing. Null: there are too many.
static TilePiece* piece_of(TilePieces* pieces, uint first, const RayScene* scene, const Piece* p, bool own_hides,
                           constant ShadowView* v) {
  for (uint i = pieces->count; i-- > first;) {
    const Piece* q = &pieces->of[i].piece;
    if (q->triangle == p->triangle && q->x == p->x && q->y == p->y && q->z == p->z &&
        q->exponent == p->exponent)
      return pieces->of + i;
  }
  if (pieces->count == MOST_PIECES) return 0;
  TilePiece* made = pieces->of + pieces->count++;
  const float edge = edge_of_piece(p->exponent);
  made->piece = *p, made->hash = hash_of_piece(p);
  made->x = (p->x + 0.5f) * edge, made->y = (p->y + 0.5f) * edge, made->z = (p->z + 0.5f) * edge;
  made->radius = 0.9f * edge;
  made->plane = scene->triangles + scene->places[p->triangle];
  const double eye = plane_distance(made->plane, v->eye_x, v->eye_y, v->eye_z, v->eye_w);
  made->eye = !own_hides ? 1 : eye > 0 ? 2 : eye < 0 ? 0 : 1;
  made->pixels = 0, made->blocks = 0, made->parts = NOT_SPLIT;
  for (uint i = 0; i < SHADOW_WORDS; ++i) made->words[i] = made->rest[i] = 0;
  return made;
}

// Puts lanes of a block into pieces of cells of this size, from the piece `first` on. Returns those that are
// in none.
static uint add_lanes(TilePieces* pieces, uint first, const RayScene* scene, const Receivers* r, uint lanes,
                      whole exponent, uint block, constant ShadowView* v) {
  const real scale = as_float16((127 - exponent) << 23);
  const real x = floor(r->at.x * scale), y = floor(r->at.y * scale), z = floor(r->at.z * scale);
  const real most = lane_max(lane_max(fabs(x), fabs(y)), fabs(z));
  uint left = lanes & lane_bits(most < 0x1p22f), taken = 0;
  while (left != 0) {
    const uint lane = lowest_bit(left);
    const Piece piece = {((const uint*)&r->own)[lane], (int)((const float*)&x)[lane],
                         (int)((const float*)&y)[lane], (int)((const float*)&z)[lane],
                         ((const int*)&exponent)[lane]};
    const mask_t here = (r->own == (whole)((int)piece.triangle)) & (exponent == (whole)(piece.exponent)) &
                        (x == REAL((float)piece.x)) & (y == REAL((float)piece.y)) &
                        (z == REAL((float)piece.z));
    const uint same = lane_bits(here) & left;
    left &= ~same;
    const uint in = same & lane_bits(in_piece(r, scene->triangles + scene->places[piece.triangle], &piece));
    if (in == 0) continue;
    TilePiece* of = piece_of(pieces, first, scene, &piece, r->own_hides, v);
    if (!of) continue;
    of->words[block / 2] |= in << 16 * (block & 1u);
    of->blocks |= 1u << block, of->pixels += popcount(in);
    taken |= in;
  }
  return lanes & ~taken;
}

// Of a block of pixels, of which all take rays where the tile has few `lights`. Cells are PIECE_PIXELS at
// most where the eye sees them.
static void add_pieces(TilePieces* pieces, const RayScene* scene, const Receivers* r, uint block, uint lights,
                       constant ShadowView* v) {
  const uint covered = lane_bits(r->own >= (whole)(0));
  if (lights < LEAST_LIGHTS) {
    pieces->others[block / 2] |= covered << 16 * (block & 1u);
    return;
  }
#ifdef ORTHOGRAPHIC
  const real squared = REAL(v->piece_scale);
#else
  const Real3 d = real3(r->at.x - v->from_x, r->at.y - v->from_y, r->at.z - v->from_z);
  const real squared = fma(d.z, d.z, fma(d.y, d.y, d.x * d.x)) * v->piece_scale;
#endif
  const whole exponent = max(min(((as_int16(squared) >> 23) - 127) >> 1, (whole)(30)), (whole)(-30));
  const uint rest = add_lanes(pieces, 0, scene, r, covered, exponent, block, v);
  pieces->others[block / 2] |= rest << 16 * (block & 1u);
}

static inline uint lanes_of_block(const uint words[SHADOW_WORDS], uint block) {
  return words[block / 2] >> 16 * (block & 1u) & 0xffffu;
}

// Of the pieces from `first` on, once they are complete: those with few pixels give them to `rest`.
static void drop_small_pieces(TilePieces* pieces, uint first, uint rest[SHADOW_WORDS]) {
  uint kept = first;
  for (uint i = first; i < pieces->count; ++i) {
    const TilePiece* p = pieces->of + i;
    if (p->pixels >= LEAST_PIXELS) {
      if (kept != i) pieces->of[kept] = *p;
      ++kept;
      continue;
    }
    for (uint w = 0; w < SHADOW_WORDS; ++w) rest[w] |= p->words[w];
  }
  pieces->count = kept;
}

static __attribute__((noinline)) void split_piece(TilePieces* pieces, uint i, const RayScene* scene,
                                                  const Receivers* receivers, constant ShadowView* v) {
  TilePiece* p = pieces->of + i;
  p->first_part = pieces->count;
  for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1) {
    const uint block = lowest_bit(blocks);
    const uint rest = add_lanes(pieces, p->first_part, scene, receivers + block,
                                lanes_of_block(p->words, block), (whole)(p->piece.exponent - 1), block, v);
    p->rest[block / 2] |= rest << 16 * (block & 1u);
  }
  drop_small_pieces(pieces, p->first_part, p->rest);
  p->parts = pieces->count - p->first_part;
}

// Lanes that one of a few triangles hides: rays_hidden without a tree.
static __attribute__((noinline)) mask_t hidden_by_few(const RayScene* scene, const Receivers* r,
                                                      global const ShadowLight* l, mask_t active,
                                                      const int* places, uint count) {
  mask_t hidden = (mask_t)(0);
  RayPacket p;
  const RaySource source = {l->x, l->y, l->z, l->w};
  set_packet(&p, source, r->at, r->gap, scene->extent);
  const RayOctants octants = octants_of(&p);
  for (uint left = lane_bits(active); left != 0;) {  // mostly once
    const uint live = take_octant(&p, &octants, left);
    left &= ~live;
    for (uint i = 0; i < count; ++i) {
      if (ray_met(scene, &p, true, places[i], r->own, &hidden) && (lane_bits(hidden) & live) == live) break;
    }
  }
  return hidden;
}

// Adds the pixels that are hidden from the light by what certificates say. `left`: pixels that take rays.
// *decided is increased by the number of the others that are not out of range.
static void hidden_by_certificates(const RayScene* scene, TilePieces* pieces, const Receivers* receivers,
                                   global const ShadowLight* l, uint light, uint next,
                                   const Certificates* certificates, constant ShadowView* v,
                                   uint words[SHADOW_WORDS], uint left[SHADOW_WORDS], uint* decided) {
  for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] = pieces->others[w];
  if (l->w == 0) {  // a directional light
    for (uint i = 0; i < pieces->count_at_first; ++i)
      for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] |= pieces->of[i].words[w];
    return;
  }
  const float x = (float)l->x, y = (float)l->y, z = (float)l->z, reach = sqrt(l->reach_squared);
  uchar todo[MOST_PIECES];
  uint height = pieces->count_at_first;
  for (uint i = 0; i < height; ++i) todo[i] = i;
#ifdef __clang__
  // The next light's, most probably.
  for (uint i = 0; i < height; ++i)
    __builtin_prefetch((global void*)set_of(certificates, pieces->of[i].hash, next), 0, 3);
#endif
  while (height != 0) {
    const uint at = todo[--height];
    TilePiece* p = pieces->of + at;
    const float dx = p->x - x, dy = p->y - y, dz = p->z - z, far = reach + p->radius;
    if (dx * dx + dy * dy + dz * dz > far * far * 1.00001f) continue;
    const double side = plane_distance(p->plane, l->x, l->y, l->z, 1);
    if ((side < 0 && p->eye == 2) || (side > 0 && p->eye == 0)) {  // they see its other side than the light
      *decided += p->pixels;
      for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1) {
        const uint block = lowest_bit(blocks);
        const uint hidden = lanes_of_block(p->words, block) & lane_bits(may_shade(receivers + block, l));
        words[block / 2] |= hidden << 16 * (block & 1u);
      }
      continue;
    }
    int places[CERTIFICATE_PLACES];
    global ShadowCertificate* set = set_of(certificates, p->hash, light);
    uint state = find_certificate(certificates, set, &p->piece, l->stamp, places);
    if (state == CERTIFICATE_NONE) {
      // One that could not be kept costs more than rays.
      volatile global ShadowCertificate* slot = claim_slot(certificates, set);
      if (!slot) {
        for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] |= p->words[w];
        continue;
      }
      state = make_certificate(scene, &p->piece, l, places);
      keep_certificate(certificates, slot, &p->piece, l->stamp, state, places);
    }
    const uint kind = state & CERTIFICATE_KIND;
    if (kind == CERTIFICATE_UNDECIDED) {
      if (p->parts == NOT_SPLIT && p->pixels >= SPLIT_PIXELS && pieces->count + 8 <= MOST_PIECES)
        split_piece(pieces, at, scene, receivers, v);
      if (p->parts == NOT_SPLIT) {
        for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] |= p->words[w];
      } else {
        for (uint w = 0; w < SHADOW_WORDS; ++w) left[w] |= p->rest[w];
        for (uint i = 0; i < p->parts; ++i) todo[height++] = p->first_part + i;
      }
      continue;
    }
    *decided += p->pixels;
    if (kind == CERTIFICATE_FREE) continue;
    const bool whole_piece = kind == CERTIFICATE_HIDDEN, reached = state & CERTIFICATE_REACHED;
    if (whole_piece && reached) {
      for (uint w = 0; w < SHADOW_WORDS; ++w) words[w] |= p->words[w];
      continue;
    }
    for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1) {
      const uint block = lowest_bit(blocks), lanes = lanes_of_block(p->words, block);
      mask_t hidden = lanes_of(lanes);
      if (!reached) hidden &= may_shade(receivers + block, l);
      if (!whole_piece && any_lane(hidden)) {
        hidden = hidden_by_few(scene, receivers + block, l, hidden, places,
                               state >> CERTIFICATE_COUNT_SHIFT & 15u);
      }
      words[block / 2] |= lane_bits(hidden) << 16 * (block & 1u);
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
static void hidden_by_rays(const RayScene* scene, const Receivers* receivers, const uint left[SHADOW_WORDS],
                           global const ShadowLight* l, constant ShadowView* v, uint words[SHADOW_WORDS],
                           uint* traced, int* last_blocker) {
  RayQueue q;
  q.count = 0;
  for (uint block = 0; block < 16; ++block) {
    const uint lanes = lanes_of_block(left, block);
    if (lanes == 0) continue;
    const Receivers* r = receivers + block;
    const mask_t reached = may_shade(r, l) & lanes_of(lanes);
    if (!any_lane(reached)) continue;
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
