// The pieces of triangles that a tile shows, and what their certificates decide of a light.
#pragma once

#include "kernels/shadows/certificates.h"

#define MOST_PIECES 32
#define LEAST_PIXELS 6u  // of a piece in a tile: fewer take rays

typedef struct TilePiece {
  Piece piece;
  uint hash;
  float x, y, z, radius;  // a ball around its points
  uint eye;             // the eye's side of the plane, plus 1
  uint pixels;
  uint blocks;                 // that show it
  uint words[SHADOW_WORDS];    // its pixels, as an entry has them
} TilePiece;

typedef struct TilePieces {
  TilePiece of[MOST_PIECES];
  uint count;
  ushort others[16];  // pixels in no piece, by block
} TilePieces;

// Lanes whose points belong to a piece: near its plane and its triangle, with all that these tests round.
static inline mask_t in_piece(const Receivers* r, global const RayTriangle* t, const Piece* piece) {
  const float edge = edge_of_piece(piece->exponent), off = off_plane(t, piece);
  if (!(off <= EDGE / 4 * edge)) return (mask_t)(0);
  mask_t in = r->slack <= off * 0.9999f;
  const int k = greatest_axis(t);
  const real at_u = k == 0 ? r->at.y : k == 1 ? r->at.z : r->at.x,
             at_v = k == 0 ? r->at.z : k == 1 ? r->at.x : r->at.y;
  const int u = (k + 1) % 3, v = (k + 2) % 3;
  const float turn = t->normal[k] < 0 ? -1.0f : 1.0f;
  for (uint i = 0; i < 3; ++i) {
    global const float *a = t->corners + 3 * i, *b = t->corners + 3 * ((i + 1) % 3);
    const float du = (b[u] - a[u]) * turn, dv = (b[v] - a[v]) * turn;
    const real x = at_u - a[u], y = at_v - a[v];
    const real inside = y * du - x * dv, slack = 0x1p-21f * (fabs(y) * fabs(du) + fabs(x) * fabs(dv));
    in &= inside - slack >= -EDGE / 2 * edge * (fabs(du) + fabs(dv));
  }
  return in;
}

static TilePiece* piece_of(TilePieces* pieces, const RayScene* scene, const Piece* p, constant ShadowView* v) {
  for (uint i = pieces->count; i-- > 0;) {
    const Piece* q = &pieces->of[i].piece;
    if (q->triangle == p->triangle && q->x == p->x && q->y == p->y && q->z == p->z && q->exponent == p->exponent)
      return pieces->of + i;
  }
  if (pieces->count == MOST_PIECES) return 0;
  TilePiece* made = pieces->of + pieces->count++;
  const float edge = edge_of_piece(p->exponent);
  made->piece = *p, made->hash = hash_of_piece(p);
  made->x = (p->x + 0.5f) * edge, made->y = (p->y + 0.5f) * edge, made->z = (p->z + 0.5f) * edge;
  made->radius = 0.9f * edge;
  const double eye =
      plane_distance(scene->triangles + scene->places[p->triangle], v->eye_x, v->eye_y, v->eye_z, v->eye_w);
  made->eye = eye > 0 ? 2 : eye < 0 ? 0 : 1;
  made->pixels = 0, made->blocks = 0;
  for (uint i = 0; i < SHADOW_WORDS; ++i) made->words[i] = 0;
  return made;
}

// Cells are PIECE_PIXELS at most where the eye sees them; finer ones further away are not asked for.
static void add_pieces(TilePieces* pieces, const RayScene* scene, const Receivers* r, uint block,
                       constant ShadowView* v) {
#ifdef ORTHOGRAPHIC
  const real squared = REAL(v->piece_scale);
#else
  const Real3 d = real3(r->at.x - v->from_x, r->at.y - v->from_y, r->at.z - v->from_z);
  const real squared = fma(d.z, d.z, fma(d.y, d.y, d.x * d.x)) * v->piece_scale;
#endif
  const whole exponent = max(min(((as_int16(squared) >> 23) - 127) >> 1, (whole)(30)), (whole)(-30));
  const real scale = as_float16((127 - exponent) << 23);
  const real x = floor(r->at.x * scale), y = floor(r->at.y * scale), z = floor(r->at.z * scale);
  const real most = lane_max(lane_max(fabs(x), fabs(y)), fabs(z));
  const uint covered = lane_bits(r->own >= (whole)(0));
  uint left = covered & lane_bits(most < 0x1p22f), taken = 0;
  while (left != 0) {
    const uint lane = lowest_bit(left);
    const Piece piece = {((const uint*)&r->own)[lane], (int)((const float*)&x)[lane],
                         (int)((const float*)&y)[lane], (int)((const float*)&z)[lane],
                         ((const int*)&exponent)[lane]};
    const mask_t here = (r->own == (whole)((int)piece.triangle)) & (exponent == (whole)(piece.exponent)) &
                        (x == REAL((float)piece.x)) & (y == REAL((float)piece.y)) & (z == REAL((float)piece.z));
    const uint same = lane_bits(here) & left;
    left &= ~same;
    const uint in =
        same & lane_bits(in_piece(r, scene->triangles + scene->places[piece.triangle], &piece));
    if (in == 0) continue;
    TilePiece* of = piece_of(pieces, scene, &piece, v);
    if (!of) continue;
    of->words[block / 2] |= in << 16 * (block & 1u);
    of->blocks |= 1u << block, of->pixels += popcount(in);
    taken |= in;
  }
  pieces->others[block] = covered & ~taken;
}

static inline uint lanes_of_block(const TilePiece* p, uint block) {
  return p->words[block / 2] >> 16 * (block & 1u) & 0xffffu;
}

// After all blocks.
static void drop_small_pieces(TilePieces* pieces) {
  uint kept = 0;
  for (uint i = 0; i < pieces->count; ++i) {
    const TilePiece* p = pieces->of + i;
    if (p->pixels >= LEAST_PIXELS) {
      pieces->of[kept++] = *p;
      continue;
    }
    for (uint left = p->blocks; left != 0; left &= left - 1)
      pieces->others[lowest_bit(left)] |= lanes_of_block(p, lowest_bit(left));
  }
  pieces->count = kept;
}

// Lanes that one of a few triangles hides: rays_hidden without a tree.
static __attribute__((noinline)) mask_t hidden_by_few(const RayScene* scene, const Receivers* r,
                                                      global const ShadowLight* l, mask_t active,
                                                      const int* places, uint count) {
  mask_t hidden = (mask_t)(0);
  RayPacket p;
  const RaySource source = {l->x, l->y, l->z, l->w};
  set_packet(&p, source, r->at, r->gap, scene->extent);
  const real end = p.end;
  const uint down_x = lane_bits(p.inverse_x < 0.0f), down_y = lane_bits(p.inverse_y < 0.0f),
             down_z = lane_bits(p.inverse_z < 0.0f);
  for (uint left = lane_bits(active); left != 0;) {  // mostly once
    const uint lane = lowest_bit(left);
    p.down = (down_x >> lane & 1) | (down_y >> lane & 1) << 1 | (down_z >> lane & 1) << 2;
    const uint live = left & (p.down & 1 ? down_x : ~down_x) & (p.down & 2 ? down_y : ~down_y) &
                      (p.down & 4 ? down_z : ~down_z);
    left &= ~live;
    p.end = lanes_of(live) ? end : REAL(-1.0f);
    for (uint i = 0; i < count; ++i) ray_met(scene, &p, true, places[i], r->own, &hidden);
  }
  return hidden;
}

// Adds the pixels that are hidden from the light by what certificates say. `left`: pixels that take rays, by
// block. *decided is increased by the number of the others that are not out of range.
static void hidden_by_certificates(const RayScene* scene, const TilePieces* pieces, const Receivers* receivers,
                                   global const ShadowLight* l, uint light, const Certificates* certificates,
                                   uint words[SHADOW_WORDS], ushort left[16], uint* decided) {
  for (uint i = 0; i < 16; ++i) left[i] = pieces->others[i];
  const float x = (float)l->x, y = (float)l->y, z = (float)l->z, reach = sqrt(l->reach_squared);
  for (uint i = 0; i < pieces->count; ++i) {
    const TilePiece* p = pieces->of + i;
    const float dx = p->x - x, dy = p->y - y, dz = p->z - z, far = reach + p->radius;
    if (dx * dx + dy * dy + dz * dz > far * far * 1.00001f) continue;
    int places[CERTIFICATE_PLACES];
    global ShadowCertificate* set = set_of(certificates, p->hash, light);
    uint state = find_certificate(certificates, set, &p->piece, l->stamp, places);
    if (state == CERTIFICATE_NONE) {
      state = make_certificate(scene, &p->piece, l, places);
      keep_certificate(certificates, set, &p->piece, l->stamp, state, places);
    }
    const uint kind = state & CERTIFICATE_KIND, side = state >> CERTIFICATE_SIDE_SHIFT & 3u;
    const bool away = (side == 0 && p->eye == 2) || (side == 2 && p->eye == 0);
    if (!away && kind == CERTIFICATE_UNDECIDED) {
      for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1)
        left[lowest_bit(blocks)] |= lanes_of_block(p, lowest_bit(blocks));
      continue;
    }
    *decided += p->pixels;
    if (!away && kind == CERTIFICATE_FREE) continue;
    const bool whole_piece = away || kind == CERTIFICATE_HIDDEN, reached = state & CERTIFICATE_REACHED;
    if (whole_piece && reached) {
      for (uint w = 0; w < SHADOW_WORDS; ++w) words[w] |= p->words[w];
      continue;
    }
    for (uint blocks = p->blocks; blocks != 0; blocks &= blocks - 1) {
      const uint block = lowest_bit(blocks), lanes = lanes_of_block(p, block);
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
