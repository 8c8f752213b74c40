// Surfaces as light passes read them from the geometry buffer, in 32-bit float, for comparison with
// surfaces.frag.
//   GBUFFER_8, GBUFFER_16, CLEARCOAT, SPECULAR, SKIN, MINNAERT: the layout (shared/gbuffer.h)
#include "shaders/common/read_gbuffer.glsl"

layout(location = 0) out vec4 normal_roughness;
layout(location = 1) out vec4 base_color_metallic;
layout(location = 2) out vec4 emissive_occlusion;  // occlusion -1: unlit; emissive is in the image, not here

#ifdef CLEARCOAT
layout(location = 3) out vec4 coat_normal_roughness;
layout(location = 4) out vec4 coat_factor;
#endif
#ifdef CLEARCOAT
#define NEXT 5
#else
#define NEXT 3
#endif
#ifdef MODELS
layout(location = NEXT) out vec4 model;  // red: its number
#endif
#ifdef SPECULAR
#ifdef MODELS
layout(location = NEXT + 1) out vec4 specular;  // f0, f90 of the dielectric part
#else
layout(location = NEXT) out vec4 specular;
#endif
#endif

void main() {
  LitSurface s = surface_of_pixel(ivec2(gl_FragCoord.xy));
  normal_roughness = vec4(s.normal, s.roughness);
  base_color_metallic = vec4(s.base_color, s.metallic);
  emissive_occlusion = vec4(vec3(0.0), s.lit ? 1.0 : -1.0);
#ifdef MODELS
  model = vec4(s.model, vec3(0.0));
#endif
#ifdef SPECULAR
  Specular found = specular_of_pixel(ivec2(gl_FragCoord.xy));
  specular = vec4(found.f0, found.f90);
#endif
#ifdef CLEARCOAT
  Coat coat = coat_of_pixel(ivec2(gl_FragCoord.xy), s.normal);
  coat_normal_roughness = vec4(coat.normal, coat.roughness);
  coat_factor = vec4(coat.factor, vec3(0.0));
#endif
}
