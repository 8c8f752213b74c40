// The surface at a fragment, as shading reads it.

#include "shaders/common/material.glsl"

VARYING in vec3 normal_view;
#if defined(NORMAL_MAP) || defined(CLEARCOAT_NORMAL_MAP)
#define TANGENTS
VARYING in vec4 tangent_view;
#endif

struct Surface {
  vec3 normal;      // view space, unit, towards the viewer's side of the surface
  vec3 base_color;  // linear
  float alpha;
  float metallic;
  float roughness;  // perceptual
  vec3 emissive;
  float occlusion;  // 1: open
  bool unlit;
#ifdef SKIN
  vec3 subsurface;
  float roll_off;  // 0: no skin
#endif
#ifdef MINNAERT
  float minnaert_k;  // 1: Lambert
#endif
#ifdef SPECULAR
  vec3 f0;  // the dielectric part's, at normal incidence; f90 at grazing incidence
  float f90;
#endif
#ifdef CLEARCOAT
  vec3 coat_normal;  // as normal
  float coat, coat_roughness;
#endif
};

// Back faces are visible only with double-sided materials.
float side_seen() { return gl_FrontFacing ? 1.0 : -1.0; }

// A triangle may be thinner than the steps that the rasteriser snaps to. Attributes are then interpolated far
// outside of it, and normals may cancel or overflow.
vec3 unit_or(vec3 v, vec3 otherwise) {
  float length_squared = dot(v, v);
  return length_squared >= 1.2e-38 && length_squared <= 3.4e38 ? normalize(v) : otherwise;
}

// The normal of the front side, unit.
vec3 geometric_normal() { return unit_or(normal_view, vec3(0.0, 0.0, 1.0)); }

#ifdef TANGENTS
// n, unit, bent by a texel of a normal map.
vec3 bent_normal(vec3 n, vec3 texel, float scale) {
  vec3 mapped = texel * 2.0 - 1.0;
  mapped.xy *= scale;
  vec3 t = tangent_view.xyz - n * dot(n, tangent_view.xyz);
  float length_squared = dot(t, t);
  t *= inversesqrt(max(length_squared, 1e-12));
  vec3 b = cross(n, t) * tangent_view.w;
  // Without a tangent the geometric normal is used, and where the texel is no direction.
  return length_squared > 1e-12 ? unit_or(mapped.x * t + mapped.y * b + mapped.z * n, n) : n;
}
#endif

vec3 shading_normal() {
  vec3 n = geometric_normal();
#ifdef NORMAL_MAP
  if (has(MATERIAL_NORMAL_MAP)) n = bent_normal(n, texture(normal_map, uv_of(2u)).xyz, material.normal_scale);
#endif
  return n * side_seen();
}

#ifdef CLEARCOAT
// KHR_materials_clearcoat: the base's normal map does not bend the coat.
void add_coat(inout Surface s) {
  vec3 n = geometric_normal();
  s.coat = has(MATERIAL_CLEARCOAT) ? material.clearcoat : 0.0;
  s.coat_roughness = material.clearcoat_roughness;
#ifdef CLEARCOAT_MAP
  if (has(MATERIAL_CLEARCOAT_MAP)) s.coat *= texture(clearcoat_map, uv_of(5u)).r;
#endif
#ifdef CLEARCOAT_ROUGHNESS_MAP
  if (has(MATERIAL_CLEARCOAT_ROUGHNESS_MAP))
    s.coat_roughness *= texture(clearcoat_roughness_map, uv_of(6u)).g;
#endif
#ifdef CLEARCOAT_NORMAL_MAP
  if (has(MATERIAL_CLEARCOAT_NORMAL_MAP)) {
    n = bent_normal(n, texture(clearcoat_normal_map, uv_of(7u)).xyz, material.clearcoat_normal_scale);
  }
#endif
  s.coat_normal = n * side_seen();
}
#endif

#ifdef SPECULAR
// KHR_materials_specular, KHR_materials_ior.
void add_specular(inout Surface s) {
  vec3 f0 = material.specular.rgb;
  s.f90 = material.specular.a;
#ifdef SPECULAR_MAP
  if (has(MATERIAL_SPECULAR_MAP)) s.f90 *= texture(specular_map, uv_of(8u)).a;
#endif
#ifdef SPECULAR_COLOR_MAP
  if (has(MATERIAL_SPECULAR_COLOR_MAP)) f0 *= texture(specular_color_map, uv_of(9u)).rgb;
#endif
  s.f0 = min(f0, 1.0) * s.f90;
}
#endif

// Perceptual roughness and metalness.
vec2 roughness_metallic_here() {
  vec2 here = vec2(material.roughness, material.metallic);
#ifdef METALLIC_ROUGHNESS_MAP
  if (has(MATERIAL_METALLIC_ROUGHNESS_MAP)) here *= texture(metallic_roughness_map, uv_of(1u)).gb;
#endif
  return here;
}

Surface surface_here() {
  Surface s;
  vec4 color = material_base_color();
  s.base_color = color.rgb;
  s.alpha = color.a;
  vec2 roughness_metallic = roughness_metallic_here();
  s.roughness = roughness_metallic.x;
  s.metallic = roughness_metallic.y;
  s.normal = shading_normal();
  s.occlusion = 1.0;
#ifdef OCCLUSION_MAP
  if (has(MATERIAL_OCCLUSION_MAP)) {
    s.occlusion = 1.0 + material.occlusion_strength * (texture(occlusion_map, uv_of(3u)).r - 1.0);
  }
#endif
  s.emissive = material.emissive.rgb;
#ifdef EMISSIVE_MAP
  if (has(MATERIAL_EMISSIVE_MAP)) s.emissive *= texture(emissive_map, uv_of(4u)).rgb;
#endif
  s.unlit = false;
#ifdef UNLIT
  s.unlit = has(MATERIAL_UNLIT);
#endif
#ifdef SKIN
  s.subsurface = material.subsurface.rgb;
  s.roll_off = material.subsurface.a;
#endif
#ifdef MINNAERT
  s.minnaert_k = material.minnaert_k;
#endif
#ifdef SPECULAR
  add_specular(s);
#endif
#ifdef CLEARCOAT
  add_coat(s);
#endif
  return s;
}
