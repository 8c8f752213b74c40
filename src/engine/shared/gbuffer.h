// The geometry buffer in OpenCL C and GLSL: two images of four channels, the position left to depth
// (src/engine/passes/common/gbuffer.h).
//   BUFFER_BITS, in GLSL GBUFFER_8, GBUFFER_16: channels of 0 to 1 in that many bits; else 32-bit float
//   8 and 16 bits  first   octahedral normal (2), perceptual roughness, metallic
//                  second  base color (3), 1 where lights reach: 0 for unlit surfaces and where nothing is.
//                          Where the material's model has a number above 0: that number as the stored
//                          integer, at most 254
//   32 bits        first   normal (3), perceptual roughness
//                  second  base color (3), 1 + metallic + 2 * the model's number; -1 - metallic for unlit
//                          surfaces, 0 where nothing is
//   SKIN, MINNAERT  some surface has a model other than Lambert's (scene/material_model.h)
//   With coats in view, a third image:
//   CLEARCOAT      coat    octahedral normal (2), perceptual roughness, factor; in 32 bits a factor below
//                          0: its normal is that of the first image
//   SPECULAR       with a surface of the scene that has a specular reflectance of its own, another image:
//                  of the dielectric part f0 (3), in 8 and 16 bits as square roots, of which 0.04 is a stored
//                  integer; f90
// In 32 bits the normal is stored directly: the two roundings of an octahedral one are visible in lobes of
// polished surfaces.
#pragma once

#include "shared/inputs.h"
#include "shared/stored_normal.h"

#if defined(SKIN) || defined(MINNAERT)
#define MODELS
#endif

#if defined(GBUFFER_8)
#define BUFFER_BITS 8
#elif defined(GBUFFER_16)
#define BUFFER_BITS 16
#elif !defined(BUFFER_BITS)
#define BUFFER_BITS 32
#endif

// The stored integer of 1, and steps of a normal's channel on either side of 0. 0 is itself a step:
// axis-aligned walls keep their normals.
#if BUFFER_BITS == 8
#define LARGEST 255.0f
#define NORMAL_STEPS 127.0f
#elif BUFFER_BITS == 16
#define LARGEST 65535.0f
#define NORMAL_STEPS 32767.0f
#endif

// A number of 0 to 1 and a stored integer as a texel has them, and the way back. OpenCL's texels are integers,
// not yet converted; those of GLSL are integers over the largest.
#if BUFFER_BITS == 32
#define STORED_ONE(x) (x)
#define ONE_OF(x) (x)
#elif defined(LIGHTGRID_GLSL)
#define STORED_ONE(x) (x)
#define ONE_OF(x) (x)
#define STORED_INTEGER(x) ((x) / LARGEST)
#define INTEGER_OF(x) ((x)*LARGEST)
#else
#define STORED_ONE(x) ((x)*LARGEST)
#define ONE_OF(x) ((x) / LARGEST)
#define STORED_INTEGER(x) (x)
#define INTEGER_OF(x) (x)
#endif

// The same of a normal's channel, -1 to 1. Rounded here: drivers differ in their conversion to fixed point.
#if BUFFER_BITS == 32
#define STORED_NORMAL(x) (x)
#define NORMAL_OF(x) (x)
#else
#define STORED_NORMAL(x) STORED_INTEGER(floor_real((x)*NORMAL_STEPS + (NORMAL_STEPS + 1.5f)))
#define NORMAL_OF(x) ((INTEGER_OF(x) - (NORMAL_STEPS + 1.0f)) / NORMAL_STEPS)
#endif

#if defined(LIGHTGRID_GLSL)
#define Texels vec4
#define texels_of vec4
#else
// Four channels of LANES pixels.
typedef struct Texels {
  real x, y, z, w;
} Texels;
static inline Texels texels_of(real x, real y, real z, real w) {
  const Texels t = {x, y, z, w};
  return t;
}
#endif

SHARED_STRUCT(GBufferTexels) { Texels first, second; };

// A surface as light passes read it.
SHARED_STRUCT(LitSurface) {
  Real3 normal;  // view space, unit
  Real3 base_color;
  real metallic, roughness;
  Lit lit;
  real model;  // number in shared/model_records.h; 0: Lambert
};

// Reflectance of the dielectric part.
SHARED_STRUCT(Specular) {
  Real3 f0;
  real f90;
};

SHARED_STRUCT(Coat) {
  Real3 normal;  // view space, unit
  real roughness, factor;
};

// The inverse of normal_of_octahedral; the third is 0.
SHARED_FUNCTION Real3 octahedral(Real3 n) {
  real sum = abs_real(n.x) + abs_real(n.y) + abs_real(n.z);
  real across = n.x / sum, up = n.y / sum;
  real folded_across = 1.0f - abs_real(up), folded_up = 1.0f - abs_real(across);
  Real3 behind = real3(across < REAL(0.0f) ? -folded_across : folded_across,
                       up < REAL(0.0f) ? -folded_up : folded_up, REAL(0.0f));
  return select3(n.z < REAL(0.0f), behind, real3(across, up, REAL(0.0f)));
}

// Squares distribute the 256 steps of a color perceptually.
SHARED_FUNCTION Real3 root_of(Real3 c) { return real3(sqrt_real(c.x), sqrt_real(c.y), sqrt_real(c.z)); }
SHARED_FUNCTION Real3 square_of(Real3 c) { return real3(c.x * c.x, c.y * c.y, c.z * c.z); }

SHARED_FUNCTION Texels specular_texel(Specular s) {
  Real3 f0 = s.f0;
#if BUFFER_BITS != 32
  f0 = root_of(f0);
#endif
  return texels_of(STORED_ONE(f0.x), STORED_ONE(f0.y), STORED_ONE(f0.z), STORED_ONE(s.f90));
}

SHARED_FUNCTION Specular specular_of_texel(Texels t) {
  Specular s;
  s.f0 = real3(ONE_OF(t.x), ONE_OF(t.y), ONE_OF(t.z));
#if BUFFER_BITS != 32
  s.f0 = square_of(s.f0);
#endif
  s.f90 = ONE_OF(t.w);
  return s;
}

// base: the normal of the surface itself.
SHARED_FUNCTION Texels coat_texel(Coat c, Real3 base) {
  Real3 place = octahedral(c.normal);
  real factor = c.factor;
#if BUFFER_BITS == 32
  Lit as_base = BOTH(BOTH(c.normal.x == base.x, c.normal.y == base.y), c.normal.z == base.z);
  factor = as_base ? -factor : factor;
#endif
  return texels_of(STORED_NORMAL(place.x), STORED_NORMAL(place.y), STORED_ONE(c.roughness),
                   STORED_ONE(factor));
}

SHARED_FUNCTION Coat coat_of_texel(Texels t, Real3 base) {
  Coat c;
  c.normal = normal_of_octahedral(NORMAL_OF(t.x), NORMAL_OF(t.y));
  c.roughness = ONE_OF(t.z);
  c.factor = ONE_OF(t.w);
#if BUFFER_BITS == 32
  c.normal = select3(t.w < REAL(0.0f), base, c.normal);
  c.factor = abs_real(t.w);
#endif
  return c;
}

SHARED_FUNCTION GBufferTexels gbuffer_texels(LitSurface s) {
  GBufferTexels t;
#if BUFFER_BITS == 32
  real model_metallic = 2.0f * s.model + 1.0f + s.metallic;
  t.first = texels_of(s.normal.x, s.normal.y, s.normal.z, s.roughness);
  t.second =
      texels_of(s.base_color.x, s.base_color.y, s.base_color.z, s.lit ? model_metallic : -1.0f - s.metallic);
#else
  Real3 place = octahedral(s.normal), color = s.base_color;
#if BUFFER_BITS == 8
  color = root_of(color);
#endif
  real lit = s.model > REAL(0.0f) ? STORED_INTEGER(s.model) : REAL(STORED_ONE(1.0f));
  t.first = texels_of(STORED_NORMAL(place.x), STORED_NORMAL(place.y), STORED_ONE(s.roughness),
                      STORED_ONE(s.metallic));
  t.second =
      texels_of(STORED_ONE(color.x), STORED_ONE(color.y), STORED_ONE(color.z), s.lit ? lit : REAL(0.0f));
#endif
  return t;
}

SHARED_FUNCTION LitSurface lit_surface(GBufferTexels t) {
  LitSurface s;
  s.model = REAL(0.0f);
  s.base_color = real3(ONE_OF(t.second.x), ONE_OF(t.second.y), ONE_OF(t.second.z));
#if BUFFER_BITS == 32
#ifdef MODELS
  s.model = max_real(floor_real((t.second.w - 1.0f) * 0.5f), REAL(0.0f));
#endif
  s.normal = real3(t.first.x, t.first.y, t.first.z);
  s.roughness = t.first.w;
  s.metallic = max_real(abs_real(t.second.w) - 1.0f - 2.0f * s.model, REAL(0.0f));
  s.lit = t.second.w > REAL(0.5f);
#else
#ifdef MODELS
  s.model = ONE_OF(t.second.w) < REAL(1.0f) ? floor_real(INTEGER_OF(t.second.w) + 0.5f) : REAL(0.0f);
#endif
#if BUFFER_BITS == 8
  s.base_color = square_of(s.base_color);
#endif
  s.normal = normal_of_octahedral(NORMAL_OF(t.first.x), NORMAL_OF(t.first.y));
  s.roughness = ONE_OF(t.first.z);
  s.metallic = ONE_OF(t.first.w);
  s.lit = t.second.w > REAL(0.0f);
#endif
  return s;
}
