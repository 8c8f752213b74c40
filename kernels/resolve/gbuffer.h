// The surface of LANES pixels, read from the geometry buffer and written to it (src/engine/passes/common/gbuffer.h).
//
// -DCLEARCOAT    with a third image, of coats
// -DSPECULAR     with another image, of the dielectric's specular reflectance
// -DSKIN, -DMINNAERT  some surface has that model: its number is in the second image
// -DBUFFER_BITS  8, 16 or 32: bits a channel (default 32)
#pragma once

#include "shared/brdf.h"
#include "shared/model_records.h"
#include "shared/stored_normal.h"

#if defined(SKIN) || defined(MINNAERT)
#define MODELS
#endif

#ifndef BUFFER_BITS
#define BUFFER_BITS 32
#endif

#if BUFFER_BITS == 32
typedef float channel_t;
typedef float4 channel4_t;
#elif BUFFER_BITS == 16
typedef ushort channel_t;
typedef ushort4 channel4_t;
#else
typedef uchar channel_t;
typedef uchar4 channel4_t;
#endif

// Four channels of LANES pixels.
typedef struct Texels {
  real x, y, z, w;
} Texels;

// As lit_surface of shaders/common/gbuffer.glsl, from stored integers in place of normalised ones.
#if BUFFER_BITS == 32
#define OF_ONE(x) (x)
#elif BUFFER_BITS == 16
#define OF_ONE(x) ((x) / 65535.0f)
#define OF_NORMAL(x) (((x)-32768.0f) / 32767.0f)
#else
#define OF_ONE(x) ((x) / 255.0f)
#define OF_NORMAL(x) (((x)-128.0f) / 127.0f)
#endif

#ifdef MODELS
// The model's number in the second image, 0 where it is Lambert's, no surface or not lit. Never past the
// table.
static inline real number_of_texel(Texels second) {
#if BUFFER_BITS == 32
  const real number = floor((second.w - 1.0f) * 0.5f);
#else
  const real none = 0.0f, number = OF_ONE(second.w) < REAL(1.0f) ? second.w : none;
#endif
  return min_real(max_real(number, REAL(0.0f)), REAL((float)MOST_MODELS));
}

static inline ShadingPoint modelled_point(ShadingPoint p, Real3 to_viewer, real number,
                                          global const MaterialModelRecord* models) {
#define MODEL_OF(i) models[(uint)LANE(number, i)]
#ifdef SKIN
  Real3 color;
  real roll_off;
  SET_LANES(float, color.x, MODEL_OF(i).subsurface[0])
  SET_LANES(float, color.y, MODEL_OF(i).subsurface[1])
  SET_LANES(float, color.z, MODEL_OF(i).subsurface[2])
  SET_LANES(float, roll_off, MODEL_OF(i).roll_off)
  p = with_skin(p, color, roll_off);
#endif
#ifdef MINNAERT
  real k;
  SET_LANES(float, k, MODEL_OF(i).minnaert_k)
  p = with_minnaert(p, to_viewer, k);
#endif
  return p;
}
#endif

static inline real metallic_of_texels(Texels first, Texels second) {
#if BUFFER_BITS != 32
  return OF_ONE(first.w);
#elif defined(MODELS)
  return second.w - 1.0f - 2.0f * number_of_texel(second);
#else
  return second.w - 1.0f;
#endif
}

static inline ShadingPoint point_of_texels(Real3 position, Real3 to_viewer, Texels first, Texels second) {
#if BUFFER_BITS == 32
  const Real3 normal = real3(first.x, first.y, first.z);
  const real roughness = first.w;
#else
  const Real3 normal = normal_of_octahedral(OF_NORMAL(first.x), OF_NORMAL(first.y));
  const real roughness = OF_ONE(first.z);
#endif
  Real3 color = real3(OF_ONE(second.x), OF_ONE(second.y), OF_ONE(second.z));
#if BUFFER_BITS == 8
  color = real3(color.x * color.x, color.y * color.y, color.z * color.z);
#endif
  return shading_point(position, to_viewer, normal, color, metallic_of_texels(first, second), roughness);
}

#ifdef SPECULAR
// As specular_of_texel of shaders/common/gbuffer.glsl.
static inline ShadingPoint specular_point(ShadingPoint p, Texels first, Texels second, Texels specular) {
  Real3 f0 = real3(OF_ONE(specular.x), OF_ONE(specular.y), OF_ONE(specular.z));
#if BUFFER_BITS != 32
  f0 = real3(f0.x * f0.x, f0.y * f0.y, f0.z * f0.z);
#endif
  return with_specular(p, metallic_of_texels(first, second), f0, OF_ONE(specular.w));
}
#endif

#ifdef CLEARCOAT
// As coat_of_texel of shaders/common/gbuffer.glsl.
static inline ShadingPoint coated_point(ShadingPoint p, Texels coat) {
#if BUFFER_BITS == 32
  const Real3 own = normal_of_octahedral(coat.x, coat.y);
  const mask_t as_base = coat.w < REAL(0.0f);
  return with_coat(p, select3(as_base, p.normal, own), fabs(coat.w), coat.z);
#else
  const Real3 normal = normal_of_octahedral(OF_NORMAL(coat.x), OF_NORMAL(coat.y));
  return with_coat(p, normal, OF_ONE(coat.w), OF_ONE(coat.z));
#endif
}
#endif

// --- Writing: as gbuffer_texels, specular_texel and coat_texel of shaders/common/gbuffer.glsl; channels as
// they are stored, integers not yet converted.
#if BUFFER_BITS == 32
#define STORED_ONE 1.0f
#define STORED_NORMAL(x) (x)
#elif BUFFER_BITS == 16
#define STORED_ONE 65535.0f
#define STORED_NORMAL(x) floor((x)*32767.0f + 32768.5f)
#else
#define STORED_ONE 255.0f
#define STORED_NORMAL(x) floor((x)*127.0f + 128.5f)
#endif

// The inverse of normal_of_octahedral.
static inline void octahedral(Real3 n, real* u, real* v) {
  const real none = 0.0f, sum = fabs(n.x) + fabs(n.y) + fabs(n.z);
  const real across = n.x / sum, up = n.y / sum;
  const real folded_across = 1.0f - fabs(up), folded_up = 1.0f - fabs(across);
  const mask_t behind = n.z < none;
  *u = behind ? (across < none ? -folded_across : folded_across) : across;
  *v = behind ? (up < none ? -folded_up : folded_up) : up;
}

// Zeros where no surface is `covered`.
static inline Texels covered_texels(Texels t, mask_t covered) {
  const real none = 0.0f;
  const Texels here = {covered ? t.x : none, covered ? t.y : none, covered ? t.z : none,
                       covered ? t.w : none};
  return here;
}

// number: of the model.
static inline void texels_of_surface(Texels* first, Texels* second, Real3 normal, Real3 color, real metallic,
                                     real roughness, real number, mask_t unlit, mask_t covered) {
#if BUFFER_BITS == 32
  const Texels a = {normal.x, normal.y, normal.z, roughness};
  const real lit = 2.0f * number + 1.0f + metallic;
  const Texels b = {color.x, color.y, color.z, unlit ? -1.0f - metallic : lit};
#else
#if BUFFER_BITS == 8
  color = real3(sqrt(color.x), sqrt(color.y), sqrt(color.z));
#endif
  real u, v;
  octahedral(normal, &u, &v);
  const Texels a = {STORED_NORMAL(u), STORED_NORMAL(v), roughness * STORED_ONE, metallic * STORED_ONE};
  const Texels b = {color.x * STORED_ONE, color.y * STORED_ONE, color.z * STORED_ONE,
                    unlit                 ? REAL(0.0f)
                    : number > REAL(0.0f) ? number
                                          : REAL(STORED_ONE)};
#endif
  *first = covered_texels(a, covered);
  *second = covered_texels(b, covered);
}

static inline Texels texels_of_specular(Real3 f0, real f90, mask_t covered) {
#if BUFFER_BITS != 32
  f0 = real3(sqrt(f0.x), sqrt(f0.y), sqrt(f0.z));
#endif
  const Texels t = {f0.x * STORED_ONE, f0.y * STORED_ONE, f0.z * STORED_ONE, f90 * STORED_ONE};
  return covered_texels(t, covered);
}

// base: the normal of the surface itself.
static inline Texels texels_of_coat(Real3 normal, Real3 base, real factor, real roughness, mask_t covered) {
  real u, v;
  octahedral(normal, &u, &v);
#if BUFFER_BITS == 32
  const mask_t as_base = (normal.x == base.x) & (normal.y == base.y) & (normal.z == base.z);
  factor = as_base ? -factor : factor;
#endif
  const Texels t = {STORED_NORMAL(u), STORED_NORMAL(v), roughness * STORED_ONE, factor * STORED_ONE};
  return covered_texels(t, covered);
}
