// From a visibility buffer to surfaces: attributes and materials of LANES pixels, one triangle and one
// material at a time. Burns, Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred Shading"
// (JCGT 2013).
//
// -DTEXTURED, -DUV1, -DVERTEX_COLOR, -DNORMAL_MAP (of the base or the coat), -DCLEARCOAT, -DSPECULAR, -DSKIN,
// -DMINNAERT  some surface of the scene has these; without, their code is not there
// -DEFFECT_NAME      the effect reads values of surfaces (shared/surface_values.h)
// -DSURFACE_NUMBERS  surfaces' numbers are required, for a geometry buffer
#pragma once

#include "kernels/common/lists.h"
#include "kernels/common/surface_attributes.h"
#include "kernels/resolve/surface_texture.h"
#include "shared/raster_instance.h"
#include "shared/real.h"
#include "shared/surface_values.h"

// triangle_instance  by triangle number
// instances, surfaces  the rasteriser's, and ours in the same order
#define RESOLVE_SCENE_LIST(X)                      \
  X(global const uint*, triangle_instance)         \
  X(global const RasterInstanceRecord*, instances) \
  X(global const uint*, indices)                   \
  X(global const float4*, clip)                    \
  X(global const SurfaceInstance*, surfaces)       \
  X(global const SurfaceVertex*, vertices)         \
  X(global const SurfaceMaterial*, materials)      \
  X(global const ushort*, texels_4) X(global const ushort*, texels_8)

typedef struct ResolveScene {
  RESOLVE_SCENE_LIST(MEMBER)
  float2 half_size;  // of the image, pixels
#ifdef HAS_SURFACE_VALUES
  SurfaceArrays values;  // by number
#endif
} ResolveScene;

// LANES pixels have these attributes of their triangles.
typedef struct Attributes {
  Real3 normal;  // view space, not yet unit
  whole material;
  real side;  // -1 on the back of a double-sided surface
#ifdef HAS_SURFACE_VALUES
  SurfaceValues values;
#endif
#ifdef SURFACE_NUMBERS
  whole surface_number;
#endif
#ifdef NORMAL_MAP
  Real3 tangent;
  real handedness;
#endif
#ifdef TEXTURED
  TexturePlace uv0;
#endif
#ifdef UV1
  TexturePlace uv1;
#endif
#ifdef VERTEX_COLOR
  real red, green, blue, alpha;
#endif
#ifdef FETCH_AHEAD
  global const SurfaceMaterial* footprint_material;  // null: no footprint is known
  Footprint footprint;                               // in that material's packed maps
#endif
} Attributes;

static inline Real3 turned(global const float* m, real x, real y, real z) {
  return real3(fma(REAL(m[0]), x, fma(REAL(m[1]), y, m[2] * z)),
               fma(REAL(m[3]), x, fma(REAL(m[4]), y, m[5] * z)),
               fma(REAL(m[6]), x, fma(REAL(m[7]), y, m[8] * z)));
}

#define KEEP(to, value) to = here ? (value) : to
#define KEEP3(to, value) to = select3(here, value, to)

#define KEEP_VALUE(kind, type, name, resource) \
  KEEP(a->values.name, (whole)((int)((global const uint*)s->values.name)[number]));
#define KEEP_VALUES(inputs, effect, own) inputs(KEEP_VALUE)

static inline void keep_place(TexturePlace* to, TexturePlace p, mask_t here) {
  KEEP(to->u, p.u);
  KEEP(to->v, p.v);
  KEEP(to->u_right, p.u_right);
  KEEP(to->v_right, p.v_right);
  KEEP(to->u_up, p.u_up);
  KEEP(to->v_up, p.v_up);
}

#ifdef VERTEX_COLOR
// Pixels' centres may lie outside of the triangle (MOST_OUTSIDE).
static inline real from_0_to_1(real x) { return lane_min(lane_max(x, REAL(0.0f)), REAL(1.0f)); }
#endif

// Into the lanes that are `here` the attributes of a triangle. (x, y): the block's first pixel.
static inline void add_triangle(Attributes* a, const ResolveScene* s, uint triangle, mask_t here, float x,
                                float y, real dx, real dy) {
  const uint instance = s->triangle_instance[triangle];
  global const RasterInstanceRecord* r = s->instances + instance;
  global const SurfaceInstance* surface = s->surfaces + instance;
  global const SurfaceMaterial* material = s->materials + surface->material;
  global const uint* index = s->indices + r->first_index + 3 * (size_t)(triangle - r->first_triangle);
  const uint i = index[0], j = index[1], k = index[2];
  global const float4* clip = s->clip + r->first_clip_vertex;
  const ScreenTriangle t = screen_triangle(clip[i], clip[j], clip[k], x, y, s->half_size);
  const Weights w = weights_at(&t, dx, dy);
  const CornerAttributes c = corner_attributes(s->vertices + r->first_vertex, i, j, k);
  KEEP(a->material, (whole)((int)surface->material));
  const uint number = surface->flags >> INSTANCE_NUMBER_SHIFT;
  SURFACE_EFFECTS(KEEP_VALUES)
#ifdef SURFACE_NUMBERS
  KEEP(a->surface_number, (whole)((int)number));
#endif
  KEEP3(a->normal, turned(surface->normal, ATTRIBUTE(c, w, s0), ATTRIBUTE(c, w, s1), ATTRIBUTE(c, w, s2)));
  if (material->flags & SURFACE_DOUBLE_SIDED) {
    const float front = surface->flags & INSTANCE_MIRRORED ? -1.0f : 1.0f;
    KEEP(a->side, w.sum < REAL(0.0f) ? REAL(-front) : REAL(front));
  } else {
    KEEP(a->side, REAL(1.0f));
  }
#ifdef TEXTURED
  keep_place(&a->uv0, TEXTURE_PLACE(c, w, &t, s8, s9), here);
#endif
#ifdef UV1
  keep_place(&a->uv1, TEXTURE_PLACE(c, w, &t, sa, sb), here);
#endif
#ifdef NORMAL_MAP
  // A tangent transforms as a direction does. A mirroring matrix turns the cross product that makes the
  // bitangent.
  const float mirror = surface->flags & INSTANCE_MIRRORED ? -1.0f : 1.0f;
  KEEP3(a->tangent,
        turned(surface->direction, ATTRIBUTE(c, w, s4), ATTRIBUTE(c, w, s5), ATTRIBUTE(c, w, s6)));
  KEEP(a->handedness, ATTRIBUTE(c, w, s3) * mirror);
#endif
#ifdef VERTEX_COLOR
  KEEP(a->red, from_0_to_1(ATTRIBUTE(c, w, sc)));
  KEEP(a->green, from_0_to_1(ATTRIBUTE(c, w, sd)));
  KEEP(a->blue, from_0_to_1(ATTRIBUTE(c, w, se)));
  KEEP(a->alpha, from_0_to_1(ATTRIBUTE(c, w, sf)));
#endif
}

// The material at LANES pixels.
typedef struct Surface {
  Real3 base_color, emissive;
  real alpha, metallic, roughness, occlusion;
  mask_t unlit;
#ifdef SKIN
  Real3 subsurface;
  real roll_off;
#endif
#ifdef MINNAERT
  real minnaert_k;
#endif
#if defined(SKIN) || defined(MINNAERT)
  real model;  // its number
#endif
#ifdef SPECULAR
  Real3 f0;  // of the dielectric part
  real f90;
#endif
#ifdef NORMAL_MAP
  Real3 mapped;  // in tangent space, scaled
  mask_t has_map;
#endif
#ifdef CLEARCOAT
  real coat, coat_roughness;
#ifdef NORMAL_MAP
  Real3 coat_mapped;
  mask_t has_coat_map;
#endif
#endif
} Surface;

// LANES surfaces: one per pixel, or those of pixels at edges.
typedef struct Resolved {
  const Attributes* attributes;
  const Surface* surface;
  real x, y, depth;  // place in pixels; reversed depth
  mask_t covered;    // lanes with a surface
} Resolved;

// Surfaces at pixel centres. (x, y): the pixel; with 16 lanes, the first pixel of the block.
static inline Resolved resolved_at(const Attributes* a, const Surface* s, uint x, uint y, real depth,
                                   mask_t covered) {
#if LANES == 16
  const Resolved r = {a, s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth, covered};
#else
  const Resolved r = {a, s, (float)x + 0.5f, (float)y + 0.5f, depth, covered};
#endif
  return r;
}

#ifdef TEXTURED
#ifdef UV1
#define PLACE_IN(map) ((map)->flags & MAP_UV1 ? a->uv1 : a->uv0)
#else
#define PLACE_IN(map) (a->uv0)
#endif

// In the packed maps; if it is not known, into `own`.
static inline const Footprint* packed_footprint(const Attributes* a, global const SurfaceMaterial* m,
                                                Footprint* own) {
#ifdef FETCH_AHEAD
  if (a->footprint_material == m) return &a->footprint;
#endif
  *own = footprint_of(m->maps, PLACE_IN(m->maps));
  return own;
}

// Channels of a material's maps; 1 where it has no map.
typedef struct MapTexels {
  Real3 base_color, normal, emissive;
  real alpha, roughness, metallic, occlusion;
#ifdef SPECULAR
  real specular;
  Real3 specular_color;
#endif
#ifdef CLEARCOAT
  real coat, coat_roughness;
  Real3 coat_normal;
#endif
} MapTexels;

// One copy of the filter serves all maps that are not packed, since each of 16 unrolled lanes takes its time
// to compile.
static inline MapTexels sample_maps(const Attributes* a, const ResolveScene* s,
                                    global const SurfaceMaterial* m) {
  const real one = 1.0f;
  MapTexels t = {real3(one, one, one), real3(one, one, one), real3(one, one, one), one, one, one, one};
#ifdef SPECULAR
  t.specular = one;
  t.specular_color = real3(one, one, one);
#endif
#ifdef CLEARCOAT
  t.coat = one;
  t.coat_roughness = one;
  t.coat_normal = real3(one, one, one);
#endif
  uint maps = m->flags & ((1u << SURFACE_MAPS) - 1u);
#ifndef CLEARCOAT
  maps &= ~(1u << SURFACE_COAT | 1u << SURFACE_COAT_ROUGHNESS | 1u << SURFACE_COAT_NORMAL);
#endif
#ifndef SPECULAR
  maps &= ~(1u << SURFACE_SPECULAR | 1u << SURFACE_SPECULAR_COLOR);
#endif
  if (m->flags & SURFACE_PACKED) {
    Footprint own;
    const Texels8 p = filtered_8(s->texels_8, m->maps, packed_footprint(a, m, &own));
    t.base_color = real3(p.c[0], p.c[1], p.c[2]);
    t.normal = real3(p.c[3], p.c[4], p.c[5]);
    t.roughness = p.c[6];
    t.metallic = p.c[7];
    maps &= ~(1u << SURFACE_BASE_COLOR | 1u << SURFACE_METALLIC_ROUGHNESS | 1u << SURFACE_NORMAL);
  }
#pragma unroll 1
  for (; maps != 0; maps &= maps - 1) {
    const uint i = lowest_bit(maps);
    global const SurfaceMap* map = m->maps + i;
    const Texels4 p = filtered_4(s->texels_4, map, PLACE_IN(map));
    const Real3 color = real3(p.c[0], p.c[1], p.c[2]);
    if (i == SURFACE_BASE_COLOR) {
      t.base_color = color;
      t.alpha = p.c[3];
    }
    if (i == SURFACE_METALLIC_ROUGHNESS) {
      t.roughness = p.c[1];
      t.metallic = p.c[2];
    }
    if (i == SURFACE_NORMAL) t.normal = color;
    if (i == SURFACE_OCCLUSION) t.occlusion = p.c[0];
    if (i == SURFACE_EMISSIVE) t.emissive = color;
#ifdef SPECULAR
    if (i == SURFACE_SPECULAR) t.specular = p.c[3];
    if (i == SURFACE_SPECULAR_COLOR) t.specular_color = color;
#endif
#ifdef CLEARCOAT
    if (i == SURFACE_COAT) t.coat = p.c[0];
    if (i == SURFACE_COAT_ROUGHNESS) t.coat_roughness = p.c[1];
    if (i == SURFACE_COAT_NORMAL) t.coat_normal = color;
#endif
  }
  return t;
}
#endif

#ifdef NORMAL_MAP
// A texel of a normal map as a direction in tangent space.
static inline Real3 mapped_normal(Real3 texel, real scale) {
  return real3((texel.x * 2.0f - 1.0f) * scale, (texel.y * 2.0f - 1.0f) * scale, texel.z * 2.0f - 1.0f);
}
#endif

// Into the lanes that are `here` what a material is there.
static inline void add_material(Surface* surface, const Attributes* a, const ResolveScene* s, uint material,
                                mask_t here) {
  global const SurfaceMaterial* m = s->materials + material;
  Real3 color = real3(REAL(m->base_color[0]), REAL(m->base_color[1]), REAL(m->base_color[2]));
  Real3 emissive = real3(REAL(m->emissive[0]), REAL(m->emissive[1]), REAL(m->emissive[2]));
  real alpha = m->base_color[3], metallic = m->metallic, roughness = m->roughness, occlusion = 1.0f;
#ifdef TEXTURED
  const MapTexels t = sample_maps(a, s, m);
  color = real3(color.x * t.base_color.x, color.y * t.base_color.y, color.z * t.base_color.z);
  emissive = real3(emissive.x * t.emissive.x, emissive.y * t.emissive.y, emissive.z * t.emissive.z);
  alpha *= t.alpha;
  roughness *= t.roughness;
  metallic *= t.metallic;
  occlusion = 1.0f + m->occlusion_strength * (t.occlusion - 1.0f);
#ifdef NORMAL_MAP
  KEEP3(surface->mapped, mapped_normal(t.normal, REAL(m->normal_scale)));
  KEEP(surface->has_map, (mask_t)(m->flags & 1u << SURFACE_NORMAL ? -1 : 0));
#endif
#endif
#ifdef SPECULAR
  Real3 f0 = real3(REAL(m->f0[0]), REAL(m->f0[1]), REAL(m->f0[2]));
  real f90 = m->specular;
#ifdef TEXTURED
  f0 = real3(f0.x * t.specular_color.x, f0.y * t.specular_color.y, f0.z * t.specular_color.z);
  f90 *= t.specular;
#endif
  KEEP3(surface->f0, real3(min_real(f0.x, REAL(1.0f)) * f90, min_real(f0.y, REAL(1.0f)) * f90,
                           min_real(f0.z, REAL(1.0f)) * f90));
  KEEP(surface->f90, f90);
#endif
#ifdef CLEARCOAT
  real coat = m->coat, coat_roughness = m->coat_roughness;
#ifdef TEXTURED
  coat *= t.coat;
  coat_roughness *= t.coat_roughness;
#ifdef NORMAL_MAP
  KEEP3(surface->coat_mapped, mapped_normal(t.coat_normal, REAL(m->coat_normal_scale)));
  KEEP(surface->has_coat_map, (mask_t)(m->flags & 1u << SURFACE_COAT_NORMAL ? -1 : 0));
#endif
#endif
  KEEP(surface->coat, coat);
  KEEP(surface->coat_roughness, coat_roughness);
#endif
#ifdef SKIN
  KEEP3(surface->subsurface, real3(REAL(m->subsurface[0]), REAL(m->subsurface[1]), REAL(m->subsurface[2])));
  KEEP(surface->roll_off, REAL(m->roll_off));
#endif
#ifdef MINNAERT
  KEEP(surface->minnaert_k, REAL(m->minnaert_k));
#endif
#if defined(SKIN) || defined(MINNAERT)
  KEEP(surface->model, REAL(m->model));
#endif
#ifdef VERTEX_COLOR
  color = real3(color.x * a->red, color.y * a->green, color.z * a->blue);
  alpha *= a->alpha;
#endif
  KEEP3(surface->base_color, color);
  KEEP3(surface->emissive, emissive);
  KEEP(surface->alpha, alpha);
  KEEP(surface->metallic, metallic);
  KEEP(surface->roughness, roughness);
  KEEP(surface->occlusion, occlusion);
  KEEP(surface->unlit, (mask_t)(m->flags & SURFACE_UNLIT ? -1 : 0));
}

// Returns whether a vector of this squared length can be made a unit vector. False for NaN.
static inline mask_t has_direction(real length_squared) {
  return (length_squared >= REAL(FLT_MIN)) & (length_squared <= REAL(FLT_MAX));
}

// As bent_normal of shaders/common/surface.glsl, in the lanes that have a map.
#ifdef NORMAL_MAP
static inline Real3 bent_normal(const Attributes* a, Real3 n, Real3 mapped, mask_t has_map) {
  const real along = dot3(n, a->tangent);
  Real3 t = real3(a->tangent.x - n.x * along, a->tangent.y - n.y * along, a->tangent.z - n.z * along);
  const real length_squared = dot3(t, t);
  t = scale3(t, inverse_sqrt_real(max_real(length_squared, REAL(1e-12f))));
  const Real3 b = scale3(cross3(n, t), a->handedness);
  const Real3 bent = add3(add3(scale3(t, mapped.x), scale3(b, mapped.y)), scale3(n, mapped.z));
  const real bent_squared = dot3(bent, bent);
  // Without a tangent, and where the texel is no direction, the geometric normal stands.
  const mask_t here = has_map & (length_squared > REAL(1e-12f)) & has_direction(bent_squared);
  KEEP3(n, scale3(bent, inverse_sqrt_real(bent_squared)));
  return n;
}
#endif

// The normal of the front side, unit. Where corners' normals cancel it is the view's axis.
static inline Real3 geometric_normal(const Attributes* a) {
  const real length_squared = dot3(a->normal, a->normal);
  const mask_t here = has_direction(length_squared);
  Real3 n = real3(REAL(0.0f), REAL(0.0f), REAL(1.0f));
  KEEP3(n, scale3(a->normal, inverse_sqrt_real(length_squared)));
  return n;
}

static inline Real3 shading_normal(const Attributes* a, const Surface* s) {
  Real3 n = geometric_normal(a);
#ifdef NORMAL_MAP
  n = bent_normal(a, n, s->mapped, s->has_map);
#endif
  return scale3(n, a->side);
}

// The number of the material's model.
static inline real number_of(const Surface* s) {
#if defined(SKIN) || defined(MINNAERT)
  return s->model;
#else
  return REAL(0.0f);
#endif
}

#ifdef CLEARCOAT
// KHR_materials_clearcoat: the base's normal map does not bend the coat.
static inline Real3 coat_normal(const Attributes* a, const Surface* s) {
  Real3 n = geometric_normal(a);
#ifdef NORMAL_MAP
  n = bent_normal(a, n, s->coat_mapped, s->has_coat_map);
#endif
  return scale3(n, a->side);
}
#endif
