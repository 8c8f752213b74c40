// Input of the oracle's shading: the surface at each pixel in 32-bit float, by the same code as the shading
// passes.
#include "shaders/common/surface.glsl"

layout(location = 0) out vec4 normal_roughness;
layout(location = 1) out vec4 base_color_metallic;
layout(location = 2) out vec4 emissive_occlusion;  // occlusion -1: unlit
#ifdef COATS  // some material in view has a coat
layout(location = 3) out vec4 coat_normal_roughness;
layout(location = 4) out vec4 coat_factor;  // red; 0: none
#endif
#ifdef COATS
#define NEXT 5
#else
#define NEXT 3
#endif
#ifdef MODELS  // some material in view has a model other than Lambert's
layout(location = NEXT) out vec4 model;  // red: its number
#endif
#ifdef SPECULAR_IMAGE  // some material in view has a specular reflectance of its own
#ifdef MODELS
layout(location = NEXT + 1) out vec4 specular;  // f0, f90 of the dielectric part
#else
layout(location = NEXT) out vec4 specular;
#endif
#endif

void main() {
  Surface s = surface_here();
  normal_roughness = vec4(s.normal, s.roughness);
  base_color_metallic = vec4(s.base_color, s.metallic);
  emissive_occlusion = vec4(s.emissive, s.unlit ? -1.0 : s.occlusion);
#ifdef MODELS
#if defined(SKIN) || defined(MINNAERT)
  model = vec4(material.model, vec3(0.0));
#else
  model = vec4(0.0);
#endif
#endif
#ifdef SPECULAR_IMAGE
#ifdef SPECULAR
  specular = vec4(s.f0, s.f90);
#else
  specular = vec4(vec3(0.04), 1.0);
#endif
#endif
#ifdef COATS
#ifdef CLEARCOAT
  coat_normal_roughness = vec4(s.coat_normal, s.coat_roughness);
  coat_factor = vec4(s.unlit ? 0.0 : s.coat, vec3(0.0));
#else
  coat_normal_roughness = vec4(0.0);
  coat_factor = vec4(0.0);
#endif
#endif
}
