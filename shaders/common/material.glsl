// The glTF 2.0 metallic-roughness material at a fragment. Each effect's code is compiled only under its
// define. A program made for exactly the effects of its materials needs no tests; one with every effect on
// (EVERYTHING_ON) tests each material's flags and gives the same bits.
//   TEXTURED, UV1, UV_TRANSFORM, VERTEX_COLOR, BASE_COLOR_MAP, METALLIC_ROUGHNESS_MAP, NORMAL_MAP,
//   OCCLUSION_MAP, EMISSIVE_MAP, MASK, UNLIT, CLEARCOAT, CLEARCOAT_MAP, CLEARCOAT_ROUGHNESS_MAP,
//   CLEARCOAT_NORMAL_MAP, SKIN, MINNAERT, SPECULAR, SPECULAR_MAP, SPECULAR_COLOR_MAP

#include "shaders/common/varying.glsl"
#include "shared/material_params.h"

#ifdef EVERYTHING_ON
#define has(flag) ((material.flags & (flag)) != 0u)
#else
#define has(flag) true
#endif

#ifdef TEXTURED
VARYING in vec2 fragment_uv0;
#endif
#ifdef UV1
VARYING in vec2 fragment_uv1;
#endif
#ifdef VERTEX_COLOR
VARYING in vec4 fragment_color;
#endif
#ifdef BASE_COLOR_MAP
uniform sampler2D base_color_map;
#endif
#ifdef METALLIC_ROUGHNESS_MAP
uniform sampler2D metallic_roughness_map;
#endif
#ifdef NORMAL_MAP
uniform sampler2D normal_map;
#endif
#ifdef OCCLUSION_MAP
uniform sampler2D occlusion_map;
#endif
#ifdef EMISSIVE_MAP
uniform sampler2D emissive_map;
#endif
#ifdef CLEARCOAT_MAP
uniform sampler2D clearcoat_map;
#endif
#ifdef CLEARCOAT_ROUGHNESS_MAP
uniform sampler2D clearcoat_roughness_map;
#endif
#ifdef CLEARCOAT_NORMAL_MAP
uniform sampler2D clearcoat_normal_map;
#endif
#ifdef SPECULAR_MAP
uniform sampler2D specular_map;
#endif
#ifdef SPECULAR_COLOR_MAP
uniform sampler2D specular_color_map;
#endif

#ifdef TEXTURED
// Past it, floats are further apart than texels are; and so that squares of derivatives do not overflow.
#define MOST_UV 1e9

bool has_uv1(uint slot) { return (material.uv_flags & (MATERIAL_UV1_FIRST << slot)) != 0u; }

// slot: index of the material's texture (shared/material_params.h).
vec2 transformed_uv(uint slot, vec2 uv) {
#ifdef UV_TRANSFORM
  if ((material.uv_flags & (MATERIAL_UV_TRANSFORM_FIRST << slot)) != 0u) {
    vec4 linear = material.uv_linear[slot];
    uv = vec2(dot(linear.xz, uv), dot(linear.yw, uv)) + material.uv_offset[slot].xy;
  }
#endif
  return mix(vec2(0.0), uv, lessThan(abs(uv), vec2(MOST_UV)));
}

vec2 uv_of(uint slot) {
  vec2 uv = fragment_uv0;
#ifdef UV1
  if (has_uv1(slot)) uv = fragment_uv1;
#endif
  return transformed_uv(slot, uv);
}
#endif

vec4 material_base_color() {
  // Precise: as `own` in base_lighting.glsl.
  precise vec4 color = material.base_color;
#ifdef BASE_COLOR_MAP
  if (has(MATERIAL_BASE_COLOR_MAP)) color *= texture(base_color_map, uv_of(0u));
#endif
#ifdef VERTEX_COLOR
#ifdef EVERYTHING_ON
  if (fragment_color.a > -0.5)  // -1 marks a mesh without colours: interpolated ones are not always exactly
                                // one
#endif
    color *= mix(vec4(0.0), min(fragment_color, 1.0), greaterThan(fragment_color, vec4(0.0)));
#endif
  return color;
}

// The alpha that a mask is tested with; `here` is the fragment's.
//   SAMPLES: at the pixel's centre, where all passes find the same. Centroids are no such place: in passes that
//   test depth first, drivers leave out the samples that it hides.
#if defined(MASK) && defined(SAMPLES)
float alpha_at_centre() {
  float alpha = material.base_color.a;
#ifdef BASE_COLOR_MAP
  vec2 uv = interpolateAtOffset(fragment_uv0, vec2(0.0));
#ifdef UV1
  if (has_uv1(0u)) uv = interpolateAtOffset(fragment_uv1, vec2(0.0));
#endif
  if (has(MATERIAL_BASE_COLOR_MAP)) alpha *= texture(base_color_map, transformed_uv(0u, uv)).a;
#endif
#ifdef VERTEX_COLOR
  float of_vertices = interpolateAtOffset(fragment_color, vec2(0.0)).a;
#ifdef EVERYTHING_ON
  if (of_vertices > -0.5)  // as in material_base_color()
#endif
    alpha *= clamp(of_vertices, 0.0, 1.0);
#endif
  return alpha;
}
#define MASK_ALPHA(here) alpha_at_centre()
#else
#define MASK_ALPHA(here) (here)
#endif
