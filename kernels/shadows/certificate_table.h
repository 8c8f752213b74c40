// The table of certificates (shared/shadow_certificates.h), which all work-items read and fill at once.
//
// A piece's version is its lock: a writer exchanges it for the next one, which is odd, and puts the one after
// that last. A reader reads it before and after it copies.
#pragma once

#include "kernels/common/fetch.h"
#include "kernels/common/hash.h"
#include "kernels/rays/rays.h"
#include "shared/shadow_certificates.h"

#define CERTIFICATE_ARGUMENTS \
  global PieceCertificates *certificates, uint certificate_sets, uint certificate_time, global uint *decided
#define CERTIFICATES \
  { certificates, certificate_sets, certificate_time }

typedef struct Certificates {
  global PieceCertificates* pieces;
  uint sets;
  uint time;  // from 1; counts up, some frames a step
} Certificates;

typedef struct Piece {
  uint triangle;  // its number
  int x, y, z, exponent;
} Piece;

static inline global PieceCertificates* set_of(const Certificates* c, const Piece* p) {
  const uint hash =
      mixed(p->triangle * 0x9e3779b1u ^ mixed((uint)p->x * 0x8da6b343u + (uint)p->y * 0xd8163841u +
                                              (uint)p->z * 0xcb1ab31fu + (uint)p->exponent));
  return c->pieces + (size_t)((ulong)hash * c->sets >> 32) * CERTIFICATE_SET;
}

static inline bool is_of_piece(volatile global PieceCertificates* of, const Piece* p) {
  return of->triangle == p->triangle && of->x == p->x && of->y == p->y && of->z == p->z &&
         of->exponent == p->exponent;
}

// Whether nobody else writes. Then unlock_piece() must follow.
static inline bool lock_piece(volatile global PieceCertificates* of) {
  const uint version = of->version;
  return !(version & 1u) && atomic_cmpxchg(&of->version, version, version + 1) == version;
}
static inline void unlock_piece(volatile global PieceCertificates* of) {
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  ++of->version;
}

// Where the piece's certificates are, or will be: in place of those of a piece that was not seen of late.
// Null: there is no room.
static inline global PieceCertificates* certificates_of(const Certificates* c, const Piece* p) {
  global PieceCertificates *set = set_of(c, p), *oldest = 0;
  uint unused = 1;  // steps of time: more than this
  for (uint i = 0; i < CERTIFICATE_SET; ++i) {
    volatile global PieceCertificates* at = set + i;
    const uint used = at->used, age = used == 0 ? 0xffffffffu : c->time - used;
    if (used != 0 && is_of_piece(at, p)) {
      if (age != 0) at->used = c->time;
      return set + i;
    }
    if (age > unused) oldest = set + i, unused = age;
  }
  volatile global PieceCertificates* at = oldest;
  if (!at || !lock_piece(at)) return 0;
  at->triangle = p->triangle, at->x = p->x, at->y = p->y, at->z = p->z, at->exponent = p->exponent;
  at->used = c->time, at->place_count = 0;
  for (uint i = 0; i < CERTIFICATE_LIGHTS; ++i) at->stamps[i] = 0;
  unlock_piece(at);
  return oldest;
}

static inline uint places_of(uint state) { return state >> CERTIFICATE_COUNT_SHIFT & 255u; }
static inline uint first_place(uint state) { return state >> CERTIFICATE_FIRST_SHIFT & 255u; }

// A bit each.
static inline uint lights_with(volatile global PieceCertificates* of, uint stamp) {
  volatile global uint16* stamps = (volatile global uint16*)of->stamps;
  return lane_bits(stamps[0] == (uint16)(stamp)) | lane_bits(stamps[1] == (uint16)(stamp)) << 16;
}

static inline volatile global uchar* light_used(volatile global PieceCertificates* of, uint light) {
  return (volatile global uchar*)of->light_used + light;
}

static inline void copy_line(PieceCertificates* to, volatile global PieceCertificates* from, uint line) {
  vstore16(((volatile global uint16*)from)[line], line, (uint*)to);
}

// Cache lines of a piece: the key, twice stamps, twice states, places.
#define FIRST_STAMPS 1
#define FIRST_STATES (FIRST_STAMPS + CERTIFICATE_LIGHTS / 16)
#define FIRST_PLACES (FIRST_STATES + CERTIFICATE_LIGHTS / 16)

// Where the piece's certificates most probably are.
static inline void prefetch_certificates(const Certificates* c, const Piece* p) {
  global uint16* lines = (global uint16*)set_of(c, p);
  FETCH(lines);
  FETCH(lines + FIRST_STAMPS);
  FETCH(lines + FIRST_STATES);
  FETCH(lines + FIRST_PLACES);
}

// Those lines that hold something: lights follow one another. False: they are those of another piece by now,
// or always being written.
static bool copy_certificates(PieceCertificates* to, volatile global PieceCertificates* from,
                              const Piece* piece) {
  for (uint tries = 0; tries < 64; ++tries) {
    const uint version = from->version;
    if (version & 1u) continue;
    read_mem_fence(CLK_GLOBAL_MEM_FENCE);
    copy_line(to, from, 0), copy_line(to, from, FIRST_STAMPS), copy_line(to, from, FIRST_STATES);
    if (to->stamps[15] != 0)
      copy_line(to, from, FIRST_STAMPS + 1), copy_line(to, from, FIRST_STATES + 1);
    else
      to->stamps[16] = 0;
    for (uint i = 0; i < CERTIFICATE_POOL / 16 && 16 * i < to->place_count; ++i)
      copy_line(to, from, FIRST_PLACES + i);
    read_mem_fence(CLK_GLOBAL_MEM_FENCE);
    if (from->version == version) return is_of_piece(from, piece);
  }
  return false;
}

static inline bool unused_light(const Certificates* c, volatile global PieceCertificates* of, uint light) {
  return of->stamps[light] == 0 || (uchar)(c->time - *light_used(of, light)) > 1;
}

// A light of the piece without a certificate, or one whose certificate was not used of late; else
// CERTIFICATE_LIGHTS.
static inline uint unused_light_of(const Certificates* c, volatile global PieceCertificates* of) {
  uint light = 0;
  while (light < CERTIFICATE_LIGHTS && !unused_light(c, of, light)) ++light;
  return light;
}

// Keeps lights that were used of late, one after the other.
static __attribute__((noinline)) void drop_lights(const Certificates* c,
                                                  volatile global PieceCertificates* of) {
  int all[CERTIFICATE_POOL];
  for (uint k = 0; k < CERTIFICATE_POOL; ++k) all[k] = of->places[k];
  uint lights = 0, count = 0;
  for (uint i = 0; i < CERTIFICATE_LIGHTS; ++i) {
    const uint stamp = of->stamps[i], state = of->states[i], used = *light_used(of, i);
    const bool drop = unused_light(c, of, i);
    of->stamps[i] = 0;
    if (drop) continue;
    for (uint k = 0; k < places_of(state); ++k) of->places[count + k] = all[first_place(state) + k];
    of->stamps[lights] = stamp, *light_used(of, lights) = used;
    of->states[lights] = (state & ((1u << CERTIFICATE_FIRST_SHIFT) - 1)) | count << CERTIFICATE_FIRST_SHIFT;
    count += places_of(state), ++lights;
  }
  of->place_count = count;
}

// Where there is no room for places, as CERTIFICATE_UNDECIDED.
static inline void keep_certificate(const Certificates* c, global PieceCertificates* pieces,
                                    const Piece* piece, uint stamp, uint state,
                                    const int places[CERTIFICATE_PLACES]) {
  volatile global PieceCertificates* of = pieces;
  if (!lock_piece(of)) return;
  uint count = places_of(state);
  if (is_of_piece(of, piece) && lights_with(of, stamp) == 0) {
    if (of->place_count + count > CERTIFICATE_POOL) drop_lights(c, of);
    const uint light = unused_light_of(c, of);
    if (of->place_count + count > CERTIFICATE_POOL) state = CERTIFICATE_UNDECIDED, count = 0;
    if (light != CERTIFICATE_LIGHTS) {
      for (uint k = 0; k < count; ++k) of->places[of->place_count + k] = places[k];
      of->stamps[light] = stamp, *light_used(of, light) = c->time;
      of->states[light] = state | of->place_count << CERTIFICATE_FIRST_SHIFT;
      of->place_count += count;
    }
  }
  unlock_piece(of);
}
