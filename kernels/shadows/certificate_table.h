// The table of certificates (shared/shadow_certificates.h), which all work-items read and fill at once.
//
// A slot's state is its lock: a writer exchanges it for CERTIFICATE_BUSY with the next version, and puts the
// new state last. A reader reads the state before and after what it takes.
#pragma once

#include "kernels/common/hash.h"
#include "kernels/rays/rays.h"
#include "shared/shadow_certificates.h"

#define CERTIFICATE_ARGUMENTS \
  global ShadowCertificate *certificates, uint certificate_sets, uint certificate_time, global uint *decided
#define CERTIFICATES \
  { certificates, certificate_sets, certificate_time }

typedef struct Certificates {
  global ShadowCertificate* slots;
  uint sets;  // a power of two
  uint time;  // counts up, some frames a step
} Certificates;

typedef struct Piece {
  uint triangle;  // its number
  int x, y, z, exponent;
} Piece;

static inline uint hash_of_piece(const Piece* p) {
  return mixed(p->triangle * 0x9e3779b1u ^ mixed((uint)p->x * 0x8da6b343u + (uint)p->y * 0xd8163841u +
                                                 (uint)p->z * 0xcb1ab31fu + (uint)p->exponent));
}

// Sets of one piece and lights that follow each other lie side by side.
static inline global ShadowCertificate* set_of(const Certificates* c, uint hash, uint light) {
  return c->slots + (size_t)((hash + light) & (c->sets - 1)) * CERTIFICATE_SET;
}

// The state, CERTIFICATE_NONE if there is none. Its places are copied where it is CERTIFICATE_FEW.
static inline uint find_certificate(const Certificates* c, global ShadowCertificate* set, const Piece* piece,
                                    uint stamp, int places[CERTIFICATE_PLACES]) {
  for (uint i = 0; i < CERTIFICATE_SET; ++i) {
    volatile global ShadowCertificate* slot = set + i;
    const uint state = slot->state;
    if ((state & CERTIFICATE_KIND) < CERTIFICATE_FREE) continue;
    read_mem_fence(CLK_GLOBAL_MEM_FENCE);
    if (slot->stamp != stamp || slot->triangle != piece->triangle || slot->x != piece->x ||
        slot->y != piece->y || slot->z != piece->z || slot->exponent != piece->exponent)
      continue;
    if ((state & CERTIFICATE_KIND) == CERTIFICATE_FEW) {
      for (uint k = 0; k < (state >> CERTIFICATE_COUNT_SHIFT & 15u); ++k) places[k] = slot->places[k];
    }
    const bool fresh = slot->used == c->time;
    read_mem_fence(CLK_GLOBAL_MEM_FENCE);
    if (slot->state != state) continue;
    if (!fresh) slot->used = c->time;
    return state;
  }
  return CERTIFICATE_NONE;
}

// A slot of the set that is empty or was not used of late, for keep_certificate. Null: there is none.
static inline volatile global ShadowCertificate* claim_slot(const Certificates* c,
                                                            global ShadowCertificate* set) {
  volatile global ShadowCertificate* slot = 0;
  uint before = 0, unused = 1;  // steps of time: more than this
  for (uint i = 0; i < CERTIFICATE_SET; ++i) {
    const uint now = ((volatile global ShadowCertificate*)set)[i].state, kind = now & CERTIFICATE_KIND;
    if (kind == CERTIFICATE_BUSY) continue;
    const uint age = kind == CERTIFICATE_NONE ? 0xffffffffu : c->time - set[i].used;
    if (age > unused) slot = set + i, before = now, unused = age;
  }
  if (!slot) return 0;
  const uint busy = ((before & (0u - CERTIFICATE_VERSION)) + CERTIFICATE_VERSION) | CERTIFICATE_BUSY;
  return atomic_cmpxchg(&slot->state, before, busy) == before ? slot : 0;
}

static inline void keep_certificate(const Certificates* c, volatile global ShadowCertificate* slot,
                                    const Piece* piece, uint stamp, uint state,
                                    const int places[CERTIFICATE_PLACES]) {
  const uint version = slot->state & (0u - CERTIFICATE_VERSION);
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  slot->stamp = stamp, slot->triangle = piece->triangle, slot->exponent = piece->exponent;
  slot->x = piece->x, slot->y = piece->y, slot->z = piece->z, slot->used = c->time;
  for (uint k = 0; k < (state >> CERTIFICATE_COUNT_SHIFT & 15u); ++k) slot->places[k] = places[k];
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  slot->state = version | state;
}
