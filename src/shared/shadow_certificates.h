// What is kept of shadows from frame to frame while nothing moves (kernels/shadows/cpu/).
//
// Certificates: of a light and a piece of a triangle, whether some point of the piece can be hidden from the
// light, and by which triangles. They lie in a table, which kernels fill and read at once.
//
// Tiles: what each showed, and the bits of its lights, when shadows were last found.
#pragma once

#include "shared/language.h"

#define CERTIFICATE_PLACES 24       // of one light, at most
#define CERTIFICATE_LIGHTS 32       // of a piece
#define CERTIFICATE_POOL 80         // places of all lights of a piece
#define CERTIFICATE_SET 4           // pieces in a row among which a key may lie
#define CERTIFICATE_FARTHEST 1.25f  // times the light's range: no piece with a certificate is further away
#define PIECE_PIXELS 32.0f          // no cell is larger on the screen, and most are larger than half of this

// A light's state: the kind, above it flags and which places are its.
#define CERTIFICATE_NONE 0       // there is none
#define CERTIFICATE_FREE 1       // no triangle but its own hides any point of the piece
#define CERTIFICATE_HIDDEN 2     // one triangle hides all of it
#define CERTIFICATE_FEW 3        // nothing hides any of it but its places
#define CERTIFICATE_UNDECIDED 4  // there may be more
#define CERTIFICATE_KIND 7u
#define CERTIFICATE_REACHED 8u       // all of it is in the light's range and cone
#define CERTIFICATE_COUNT_SHIFT 8    // 8 bits: places
#define CERTIFICATE_FIRST_SHIFT 16u  // 8 bits: the first of them

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

// The certificates of a piece, one a light. Whole cache lines; the key is triangle, cell and exponent. Zeros
// hold no certificate.
typedef struct PieceCertificates {
  uint version;   // odd: being written
  uint triangle;  // its number
  int x, y, z;    // cell of the world's grid whose cells are 2^exponent metres a side
  int exponent;
  uint used;                                // when the piece was seen last; 0: never
  uint place_count;                         // of all lights
  uint light_used[CERTIFICATE_LIGHTS / 4];  // when each was last, a byte each
  uint stamps[CERTIFICATE_LIGHTS];          // ShadowLight::stamp; 0: no light
  uint states[CERTIFICATE_LIGHTS];
  int places[CERTIFICATE_POOL];
} PieceCertificates;

// Of the last frame's KeptShadows those of a tile.
typedef struct KeptTile {
  uint view;  // ShadowView::stamp; 0: nothing is kept
  uint first, count;
} KeptTile;

// A listed light's bits in a tile, as the entry of shared/shadow_bits.h has them.
typedef struct KeptShadow {
  uint light, stamp;  // ShadowLight::stamp
  uint words[8];
} KeptShadow;

#define KEPT_SURFACE_WORDS 512  // of a tile, block by block: 16 triangles, 16 depths

#if !defined(__OPENCL_VERSION__)
static_assert(sizeof(PieceCertificates) % 64 == 0 && sizeof(KeptShadow) == 40);
}  // namespace lightgrid
#endif
