// Reads a pixel's surface from the geometry buffer and the depth image.
//   SKIN, MINNAERT: some surface has that model (scene/material_model.h)
#if defined(SKIN) || defined(MINNAERT)
#define MODELS
#endif
#include "shaders/common/gbuffer.glsl"
#include "shaders/common/position.glsl"

uniform sampler2D gbuffer_normal_roughness_metallic;
uniform sampler2D gbuffer_base_color_lit;
uniform sampler2D depth_image;
#ifdef CLEARCOAT
uniform sampler2D gbuffer_coat;
#endif

#ifdef SPECULAR
uniform sampler2D gbuffer_specular;
#endif

LitSurface surface_of_pixel(ivec2 pixel) {
  return lit_surface(GBufferTexels(texelFetch(gbuffer_normal_roughness_metallic, pixel, 0),
                                   texelFetch(gbuffer_base_color_lit, pixel, 0)));
}

#ifdef CLEARCOAT
// base: the normal of surface_of_pixel.
Coat coat_of_pixel(ivec2 pixel, vec3 base) { return coat_of_texel(texelFetch(gbuffer_coat, pixel, 0), base); }
#endif

#ifdef SPECULAR
Specular specular_of_pixel(ivec2 pixel) { return specular_of_texel(texelFetch(gbuffer_specular, pixel, 0)); }
#endif

#ifdef MODELS
#include "shared/model_records.h"
#endif
