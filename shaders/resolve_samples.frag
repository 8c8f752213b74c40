// The mean of a pixel's samples, as AVERAGE_… says (shared/average.h): of light without it. SAMPLES: how many
// there are.
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
