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

#ifdef MASK
#ifdef SAMPLES
// At an offset from the pixel's centre, in pixels. All passes find the same there. Centroids are no such
// place: in passes that test depth first, drivers leave out the samples that it hides.
vec2 mask_uv(vec2 offset) {
#ifdef BASE_COLOR_MAP
  vec2 uv = interpolateAtOffset(fragment_uv0, offset);
#ifdef UV1
  if (has_uv1(0u)) uv = interpolateAtOffset(fragment_uv1, offset);
#endif
  return transformed_uv(0u, uv);
#else
  return offset;
#endif
}

// Without the map's.
float own_alpha(vec2 offset) {
  float alpha = material.base_color.a;
#ifdef VERTEX_COLOR
  float of_vertices = interpolateAtOffset(fragment_color, offset).a;
#ifdef EVERYTHING_ON
  if (of_vertices > -0.5)  // as in material_base_color()
#endif
    alpha *= clamp(of_vertices, 0.0, 1.0);
#endif
  return alpha;
}

float alpha_at_centre() {
  float alpha = own_alpha(vec2(0.0));
#ifdef BASE_COLOR_MAP
  if (has(MATERIAL_BASE_COLOR_MAP)) alpha *= texture(base_color_map, mask_uv(vec2(0.0))).a;
#endif
  return alpha;
}
#endif

// Which samples a mask is tested at (shared/sample_masks.h); without a define at the pixel's centre.
//   MASKS_AT_SAMPLES, MASKS_BY_COVERAGE  with SAMPLE_OFFSETS: from the centre, pixels
//   MASKS_OF_CENTRES                     at centres all the same
#if defined(SAMPLES) && !defined(MASKS_OF_CENTRES) && \
    (defined(MASKS_AT_SAMPLES) || defined(MASKS_BY_COVERAGE))
const vec2 sample_offsets[SAMPLES] = vec2[](SAMPLE_OFFSETS);

#ifdef MASKS_AT_SAMPLES
// A look-up's texels are the sample's share of the pixel.
struct MaskPlane {
  vec2 uv_right, uv_up;
};

MaskPlane mask_plane() {
  const float side = inversesqrt(float(SAMPLES));
  vec2 uv = mask_uv(vec2(0.0));
  return MaskPlane(dFdx(uv) * side, dFdy(uv) * side);
}
float alpha_of_sample(MaskPlane p, vec2 offset) {
  float alpha = own_alpha(offset);
#ifdef BASE_COLOR_MAP
  if (has(MATERIAL_BASE_COLOR_MAP))
    alpha *= textureGrad(base_color_map, mask_uv(offset), p.uv_right, p.uv_up).a;
#endif
  return alpha;
}
#else
// Alpha and its slope at the centre: alpha to coverage, sharpened around the cutoff
// (kernels/raster/raster_masks.h).
struct MaskPlane {
  float alpha, right, up;
};

MaskPlane mask_plane() {
  float alpha = alpha_at_centre();
  return MaskPlane(alpha, dFdx(alpha), dFdy(alpha));
}
float alpha_of_sample(MaskPlane p, vec2 offset) { return p.alpha + p.right * offset.x + p.up * offset.y; }
#endif

// Leaves out what the mask hides: samples or the fragment.
void apply_mask(float here) {
#ifndef PER_SAMPLE
  gl_SampleMask[0] = ~0;
#endif
  MaskPlane p = mask_plane();
  if (!has(MATERIAL_MASK)) return;
#ifdef PER_SAMPLE
  if (alpha_of_sample(p, sample_offsets[gl_SampleID]) < material.alpha_cutoff) discard;
#else
  int shown = 0;
  for (int s = 0; s < SAMPLES; ++s)
    if (alpha_of_sample(p, sample_offsets[s]) >= material.alpha_cutoff) shown |= 1 << s;
  if (shown == 0) discard;
  gl_SampleMask[0] = shown;
#endif
}
#else
// Leaves out the fragment where the mask hides it; `here` is its alpha.
void apply_mask(float here) {
#ifdef SAMPLES
  here = alpha_at_centre();
#endif
  if (has(MATERIAL_MASK) && here < material.alpha_cutoff) discard;
}
#endif
#endif
