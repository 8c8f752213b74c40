// The light buffer in place of a loop over lights: light_prepass.
//   LIGHT_EXPONENT, LIGHT_REFERENCE: LightBufferParams (shared/light_buffer.h)
//   LIGHT_SCALE: a sum of this size is stored as 1
//   PREPASS_FIFTH_TERM: there is a second image
//   LIGHT_LUV: colours are stored as hue and luminance (shared/light_luv.h)
//   SAMPLES: the image has so many a pixel; SAMPLES_IN_A_ROW: it has one, and a pixel's samples are texels
//   beside one another
#include "shared/light_buffer.h"
#include "shared/light_luv.h"

uniform frame_sampler2D light_buffer;
#ifdef PREPASS_FIFTH_TERM
uniform frame_sampler2D light_buffer_second;
#endif

vec3 light_sum(ShadingPoint p) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef SAMPLES_IN_A_ROW
  pixel.x = pixel.x * SAMPLES + gl_SampleID;
#endif
  vec4 first = texelFetch(light_buffer, pixel, SAMPLE_HERE);
#ifdef LIGHT_LUV
  first.rgb = light_of_luv(first.rgb);
#endif
  first *= LIGHT_SCALE;
  LightTerms sums = no_terms();
  sums.diffuse = first.rgb;
  sums.specular = first.a;
#ifdef PREPASS_FIFTH_TERM
  vec2 second = texelFetch(light_buffer_second, pixel, SAMPLE_HERE).rg * LIGHT_SCALE;
  sums.weight = second.x;
  sums.rim = second.y;
#endif
  return light_of_terms(p, sums, LightBufferParams(LIGHT_EXPONENT, LIGHT_REFERENCE));
}
