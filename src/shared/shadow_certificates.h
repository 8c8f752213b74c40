// What is known of a light and a piece of a triangle for as long as nothing moves: whether some point of the
// piece can be hidden from the light, and by which triangles (kernels/shadows/certificates.h). They lie in a
// table, which kernels fill and read at once.
#pragma once

#include "shared/language.h"

#define CERTIFICATE_PLACES 8
#define CERTIFICATE_SET 4           // slots in a row that a key may lie in
#define CERTIFICATE_FARTHEST 1.25f  // times the light's range: no piece with a certificate is further away
#define PIECE_PIXELS 64.0f          // no cell is larger on the screen, and most are larger than half of this

// The low byte of `state`; above it flags, then a version that each writer of the slot counts up.
#define CERTIFICATE_NONE 0
#define CERTIFICATE_BUSY 1       // being written
#define CERTIFICATE_FREE 2       // no triangle but its own hides any point of the piece
#define CERTIFICATE_HIDDEN 3     // places[0] hides all of it
#define CERTIFICATE_FEW 4        // nothing hides any of it but these places
#define CERTIFICATE_UNDECIDED 5  // there may be more
#define CERTIFICATE_KIND 7u
#define CERTIFICATE_COUNT_SHIFT 3  // 4 bits: places
#define CERTIFICATE_REACHED 128u   // all of it is in the light's range and cone
#define CERTIFICATE_VERSION 0x10000u

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// A cache line. The key is stamp, triangle, cell and exponent.
typedef struct ShadowCertificate {
  uint state;
  uint stamp;     // ShadowLight::stamp
  uint triangle;  // its number
  int x, y, z;    // cell of the world's grid whose cells are 2^exponent metres a side
  int exponent;
  uint used;  // when it was last
  int places[CERTIFICATE_PLACES];
} ShadowCertificate;

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(ShadowCertificate) == 64);
}  // namespace lightgrid
#endif
