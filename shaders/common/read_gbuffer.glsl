// Reads a pixel's surface, with SAMPLES that of the sample here, from the geometry buffer and the depth image.
//   SKIN, MINNAERT: some surface has that model (scene/material_model.h)
#include "shared/gbuffer.h"
#include "shaders/common/per_sample.glsl"
#include "shaders/common/position.glsl"

uniform frame_sampler2D gbuffer_normal_roughness_metallic;
uniform frame_sampler2D gbuffer_base_color_lit;
uniform frame_sampler2D depth_image;
#ifdef CLEARCOAT
uniform frame_sampler2D gbuffer_coat;
#endif

#ifdef SPECULAR
uniform frame_sampler2D gbuffer_specular;
#endif

LitSurface surface_of_pixel(ivec2 pixel) {
  return lit_surface(GBufferTexels(texelFetch(gbuffer_normal_roughness_metallic, pixel, SAMPLE_HERE),
                                   texelFetch(gbuffer_base_color_lit, pixel, SAMPLE_HERE)));
}

#ifdef CLEARCOAT
// base: the normal of surface_of_pixel.
Coat coat_of_pixel(ivec2 pixel, vec3 base) {
  return coat_of_texel(texelFetch(gbuffer_coat, pixel, SAMPLE_HERE), base);
}
#endif

#ifdef SPECULAR
Specular specular_of_pixel(ivec2 pixel) {
  return specular_of_texel(texelFetch(gbuffer_specular, pixel, SAMPLE_HERE));
}
#endif

#ifdef MODELS
#include "shared/model_records.h"
#endif
