// Writes a surface into the geometry buffer, and base lighting into the image, to which light passes only
// add.
//   GBUFFER_8, GBUFFER_16: the layout (shared/gbuffer.h)
//   BASE_LIGHTING: there is an image to write
//   NUMBER_LOCATION: there is an image of the surfaces' numbers, at this location
//   COATS, SPECULAR_IMAGE: there is an image of coats; of specular reflectance
#include "shaders/common/surface.glsl"
#include "shared/gbuffer.h"

layout(location = 0) out vec4 normal_roughness_metallic;
layout(location = 1) out vec4 base_color_lit;
#ifdef BASE_LIGHTING
#include "shaders/common/position.glsl"
#include "shared/brdf.h"
#include "shaders/common/point_of_surface.glsl"
#include "shaders/common/base_lighting.glsl"

layout(location = 2) out vec4 radiance;

vec3 light_of(Surface s) {
#ifdef UNLIT
  if (s.unlit) return s.base_color;
#endif
  return base_lighting(s, point_of_surface(s));
}
#endif

#ifdef BASE_LIGHTING
#define NEXT 3
#else
#define NEXT 2
#endif
#ifdef COATS
layout(location = NEXT) out vec4 coat;
#endif
#ifdef SPECULAR_IMAGE
#ifdef COATS
layout(location = NEXT + 1) out vec4 specular;
#else
layout(location = NEXT) out vec4 specular;
#endif
#endif

#ifdef NUMBER_LOCATION
layout(location = NUMBER_LOCATION) out uint surface_number;
#include "shaders/common/number_of_draw.glsl"
#endif

void main() {
  Surface s = surface_here();
#ifdef MASK
  apply_mask(s.alpha);
#endif
#if defined(SKIN) || defined(MINNAERT)
  float model = float(int(material.model));
#else
  float model = 0.0;
#endif
  GBufferTexels texels =
      gbuffer_texels(LitSurface(s.normal, s.base_color, s.metallic, s.roughness, !s.unlit, model));
  normal_roughness_metallic = texels.first;
  base_color_lit = texels.second;
#ifdef COATS
#ifdef CLEARCOAT
  coat = coat_texel(Coat(s.coat_normal, s.coat_roughness, s.coat), s.normal);
#else
  coat = vec4(0.0);
#endif
#endif
#ifdef SPECULAR_IMAGE
#ifdef SPECULAR
  specular = specular_texel(Specular(s.f0, s.f90));
#else
  specular = specular_texel(Specular(vec3(0.04), 1.0));
#endif
#endif
#ifdef NUMBER_LOCATION
  surface_number = surface_number_of_draw;
#endif
#ifdef BASE_LIGHTING
  radiance = vec4(light_of(s), 1.0);
#endif
}
