// The pieces of triangles that a tile shows, and their certificates.
#pragma once

#include "kernels/shadows/certificates.h"

#define LEAST_PIXELS 4u  // of a piece in a tile: fewer take rays
#define MOST_PIECES (SHADOW_TILE * SHADOW_TILE / LEAST_PIXELS)
#define LEAST_LIGHTS 2u  // of a tile, else grouping its pixels costs more than rays

typedef struct TilePiece {
  Piece piece;
  float x, y, z, radius;  // a ball around its points
  global const RayTriangle* plane;
  uint eye;  // the eye's side of it, plus 1; 1 also where it lets light through
  uint pixels;
  uint blocks;                             // that show it
  uint words[SHADOW_WORDS];                // its pixels, as an entry has them
  global PieceCertificates* certificates;  // null: there is no room for any
} TilePiece;

typedef struct TilePieces {
  TilePiece of[2 * MOST_PIECES];        // before small ones are dropped
  PieceCertificates kept[MOST_PIECES];  // as the table has them
  uint count;
  uint others[SHADOW_WORDS];  // pixels in no piece
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

// Added if it is missing. Null: there are too many.
static TilePiece* piece_of(TilePieces* pieces, const RayScene* scene, const Piece* p, bool own_hides,
                           constant ShadowView* v) {
  for (uint i = pieces->count; i-- > 0;) {
    const Piece* q = &pieces->of[i].piece;
    if (q->triangle == p->triangle && q->x == p->x && q->y == p->y && q->z == p->z &&
        q->exponent == p->exponent)
      return pieces->of + i;
  }
  if (pieces->count == 2 * MOST_PIECES) return 0;
  TilePiece* made = pieces->of + pieces->count++;
  const float edge = edge_of_piece(p->exponent);
  made->piece = *p;
  made->x = (p->x + 0.5f) * edge, made->y = (p->y + 0.5f) * edge, made->z = (p->z + 0.5f) * edge;
  made->radius = 0.9f * edge;
  made->plane = scene->triangles + scene->places[p->triangle];
  const double eye = plane_distance(made->plane, v->eye_x, v->eye_y, v->eye_z, v->eye_w);
  made->eye = !own_hides ? 1 : eye > 0 ? 2 : eye < 0 ? 0 : 1;
  made->pixels = 0, made->blocks = 0;
  for (uint i = 0; i < SHADOW_WORDS; ++i) made->words[i] = 0;
  return made;
}

// Puts the pixels of a block into pieces. Cells are PIECE_PIXELS at most where the eye sees them.
static void add_block(TilePieces* pieces, const RayScene* scene, const Receivers* r, uint block,
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
                        (x == REAL((float)piece.x)) & (y == REAL((float)piece.y)) &
                        (z == REAL((float)piece.z));
    const uint same = lane_bits(here) & left;
    left &= ~same;
    const uint in = same & lane_bits(in_piece(r, scene->triangles + scene->places[piece.triangle], &piece));
    if (in == 0) continue;
    TilePiece* of = piece_of(pieces, scene, &piece, r->own_hides, v);
    if (!of) continue;
    of->words[block / 2] |= in << 16 * (block & 1u);
    of->blocks |= 1u << block, of->pixels += popcount(in);
    taken |= in;
  }
  pieces->others[block / 2] |= (covered & ~taken) << 16 * (block & 1u);
}

// Those with few pixels give them to `others`; the rest get their certificates.
static void finish_pieces(TilePieces* pieces, const Certificates* c) {
  uint count = 0;
  for (uint i = 0; i < pieces->count; ++i) {
    TilePiece* p = pieces->of + i;
    if (p->pixels < LEAST_PIXELS) {
      for (uint w = 0; w < SHADOW_WORDS; ++w) pieces->others[w] |= p->words[w];
      continue;
    }
    prefetch_certificates(c, &p->piece);
    if (count != i) pieces->of[count] = *p;
    ++count;
  }
  pieces->count = count;
  for (uint i = 0; i < count; ++i) {
    TilePiece* p = pieces->of + i;
    p->certificates = certificates_of(c, &p->piece);
    if (p->certificates && !copy_certificates(pieces->kept + i, p->certificates, &p->piece))
      p->certificates = 0;
  }
}

// used: blocks with a surface.
static __attribute__((noinline)) void set_pieces(TilePieces* pieces, const RayScene* scene,
                                                 const Receivers* receivers, uint used, const Certificates* c,
                                                 constant ShadowView* v) {
  pieces->count = 0;
  for (uint w = 0; w < SHADOW_WORDS; ++w) pieces->others[w] = 0;
  for (; used != 0; used &= used - 1)
    add_block(pieces, scene, receivers + lowest_bit(used), lowest_bit(used), v);
  finish_pieces(pieces, c);
}

// Of a tile with too few lights: all pixels take rays.
static inline void set_no_pieces(TilePieces* pieces, const Receivers* receivers, uint used) {
  pieces->count = 0;
  for (uint w = 0; w < SHADOW_WORDS; ++w) pieces->others[w] = 0;
  for (; used != 0; used &= used - 1) {
    const uint block = lowest_bit(used);
    pieces->others[block / 2] |= lane_bits(receivers[block].own >= (whole)(0)) << 16 * (block & 1u);
  }
}
