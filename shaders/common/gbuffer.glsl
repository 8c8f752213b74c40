// The geometry buffer: two images of four channels, the position left to depth (src/engine/passes/common/gbuffer.h).
//   GBUFFER_8, GBUFFER_16: channels of 0 to 1 in that many bits; else 32-bit float
//   8 and 16 bits  first   octahedral normal (2), perceptual roughness, metallic
//                  second  base color (3), 1 where lights reach: 0 for unlit surfaces and where nothing is.
//                          Where the material's model has a number above 0: that number as the stored
//                          integer, at most 254
//   32 bits        first   normal (3), perceptual roughness
//                  second  base color (3), 1 + metallic + 2 * the model's number; -1 - metallic for unlit
//                          surfaces, 0 where nothing is
//   MODELS         some surface has a model other than Lambert's (scene/material_model.h)
//   With coats in view, a third image:
//   CLEARCOAT      coat    octahedral normal (2), perceptual roughness, factor; in 32 bits a factor below
//                          0: its normal is that of the first image
//   SPECULAR       with a surface of the scene that has a specular reflectance of its own, another image:
//                  of the dielectric part f0 (3), in 8 and 16 bits as square roots, of which 0.04 is a stored
//                  integer; f90
// In 32 bits the normal is stored directly: the two roundings of an octahedral one are visible in lobes of
// polished surfaces.

#include "shared/stored_normal.h"

// LARGEST: the stored integer of 1. Steps of a normal's channel on either side of 0. 0 is itself a step:
// axis-aligned walls keep their normals.
#if defined(GBUFFER_8)
#define NORMAL_STEPS 127.0
#define LARGEST 255.0
#elif defined(GBUFFER_16)
#define NORMAL_STEPS 32767.0
#define LARGEST 65535.0
#endif

struct GBufferTexels {
  vec4 normal_roughness_metallic, base_color_lit;
};

// A surface as light passes read it.
struct LitSurface {
  vec3 normal;  // view space, unit
  vec3 base_color;
  float metallic, roughness;
  bool lit;
  int model;  // number in shaders/common/read_gbuffer.glsl; 0: Lambert
};

// Reflectance of the dielectric part.
struct Specular {
  vec3 f0;
  float f90;
};
const Specular default_specular = Specular(vec3(0.04), 1.0);

struct Coat {
  vec3 normal;  // view space, unit
  float roughness, factor;
};

vec2 signs(vec2 v) { return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

// The inverse: normal_of_octahedral.
vec2 octahedral(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  return n.z < 0.0 ? (1.0 - abs(p.yx)) * signs(p) : p;
}

#ifdef NORMAL_STEPS
vec4 specular_texel(Specular s) { return vec4(sqrt(s.f0), s.f90); }
Specular specular_of_texel(vec4 t) { return Specular(t.rgb * t.rgb, t.a); }
#else
vec4 specular_texel(Specular s) { return vec4(s.f0, s.f90); }
Specular specular_of_texel(vec4 t) { return Specular(t.rgb, t.a); }
#endif

// base: the normal of the surface itself.
#ifndef NORMAL_STEPS
vec4 coat_texel(Coat c, vec3 base) {
  return vec4(octahedral(c.normal), c.roughness, c.normal == base ? -c.factor : c.factor);
}

Coat coat_of_texel(vec4 t, vec3 base) {
  return Coat(t.w < 0.0 ? base : normal_of_octahedral(t.x, t.y), t.z, abs(t.w));
}

GBufferTexels gbuffer_texels(LitSurface s) {
  float model_metallic = 2.0 * float(s.model) + 1.0 + s.metallic;
  return GBufferTexels(vec4(s.normal, s.roughness),
                       vec4(s.base_color, s.lit ? model_metallic : -1.0 - s.metallic));
}

LitSurface lit_surface(GBufferTexels t) {
  int model = 0;
#ifdef MODELS
  model = max(int(floor((t.base_color_lit.a - 1.0) * 0.5)), 0);
#endif
  float metallic = max(abs(t.base_color_lit.a) - 1.0 - 2.0 * float(model), 0.0);
  return LitSurface(t.normal_roughness_metallic.xyz, t.base_color_lit.rgb, metallic,
                    t.normal_roughness_metallic.w, t.base_color_lit.a > 0.5, model);
}
#else
// Rounded here: drivers differ in their conversion to fixed point.
vec2 stored_normal(vec3 normal) {
  return floor(octahedral(normal) * NORMAL_STEPS + (NORMAL_STEPS + 1.5)) / (2.0 * NORMAL_STEPS + 1.0);
}

vec3 normal_of_stored(vec2 stored) {
  vec2 normal = (stored * (2.0 * NORMAL_STEPS + 1.0) - (NORMAL_STEPS + 1.0)) / NORMAL_STEPS;
  return normal_of_octahedral(normal.x, normal.y);
}

vec4 coat_texel(Coat c, vec3 base) { return vec4(stored_normal(c.normal), c.roughness, c.factor); }

Coat coat_of_texel(vec4 t, vec3 base) { return Coat(normal_of_stored(t.xy), t.z, t.w); }

GBufferTexels gbuffer_texels(LitSurface s) {
  vec2 normal = stored_normal(s.normal);
  vec3 color = s.base_color;
#ifdef GBUFFER_8
  color = sqrt(color);  // distributes the 256 steps perceptually
#endif
  float lit = s.model == 0 ? 1.0 : float(s.model) / LARGEST;
  return GBufferTexels(vec4(normal, s.roughness, s.metallic), vec4(color, s.lit ? lit : 0.0));
}

LitSurface lit_surface(GBufferTexels t) {
  vec3 color = t.base_color_lit.rgb;
#ifdef GBUFFER_8
  color *= color;
#endif
  int model = 0;
  bool lit = t.base_color_lit.a > 0.0;
#ifdef MODELS
  model = t.base_color_lit.a < 1.0 ? int(t.base_color_lit.a * LARGEST + 0.5) : 0;
#endif
  return LitSurface(normal_of_stored(t.normal_roughness_metallic.xy), color, t.normal_roughness_metallic.w,
                    t.normal_roughness_metallic.z, lit, model);
}
#endif
