// Where a fragment is shaded: x and y in pixels, and the depth there.
//   SAMPLES: of a pixel that the triangle covers whole, its centre, as with one sample; of others where the
//   varyings are.
//   PER_SAMPLE: the sample's place
#ifdef SAMPLES
#include "shared/view_params.h"
#include "shaders/common/varying.glsl"

VARYING in vec4 clip_here;

vec3 fragment_place() {
#ifndef PER_SAMPLE
  const int whole = (1 << SAMPLES) - 1;
  if ((gl_SampleMaskIn[0] & whole) == whole) return gl_FragCoord.xyz;
#endif
  vec3 device = clip_here.xyz / clip_here.w;
  return vec3((device.xy * 0.5 + 0.5) * vec2(view.width, view.height), device.z);
}
#else
vec3 fragment_place() { return gl_FragCoord.xyz; }
#endif
