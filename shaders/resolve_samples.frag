// The average of a pixel's SAMPLES (shared/average.h): the mean of their light without AVERAGE_…. Equal samples
// keep their bits.
#include "shared/average.h"

uniform sampler2DMS image;

layout(location = 0) out vec4 color;

void main() {
  vec4 first = texelFetch(image, ivec2(gl_FragCoord.xy), 0), sum = vec4(0.0);
  float alpha = 0.0;
  bool alike = true;
  for (int s = 0; s < SAMPLES; ++s) {
    vec4 texel = texelFetch(image, ivec2(gl_FragCoord.xy), s);
    alike = alike && texel == first;
    sum = add_light(sum, texel.rgb, 1.0 / float(SAMPLES));
    alpha += texel.a;
  }
  color = alike ? first : vec4(averaged(sum).rgb, alpha * (1.0 / float(SAMPLES)));
}
