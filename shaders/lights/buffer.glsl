// The light buffer in place of a loop over lights: light_prepass.
//   LIGHT_EXPONENT, LIGHT_REFERENCE: LightBufferParams (shared/light_buffer.h)
//   LIGHT_SCALE: a sum of this size is stored as 1
//   PREPASS_FIFTH_TERM: there is a second image
#include "shared/light_buffer.h"

uniform sampler2D light_buffer;
#ifdef PREPASS_FIFTH_TERM
uniform sampler2D light_buffer_second;
#endif

vec3 light_sum(ShadingPoint p) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 first = texelFetch(light_buffer, pixel, 0) * LIGHT_SCALE;
  LightTerms sums = no_terms();
  sums.diffuse = first.rgb;
  sums.specular = first.a;
#ifdef PREPASS_FIFTH_TERM
  vec2 second = texelFetch(light_buffer_second, pixel, 0).rg * LIGHT_SCALE;
  sums.weight = second.x;
  sums.rim = second.y;
#endif
  return light_of_terms(p, sums, LightBufferParams(LIGHT_EXPONENT, LIGHT_REFERENCE));
}
