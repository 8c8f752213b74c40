// The picture in bytes, as kernels/resolve/tone_map.cl has it.
#include "shared/tone_map.h"

uniform sampler2D image;  // linear, one sample a pixel
uniform float scale;      // the exposure's

layout(location = 0) out vec4 color;

void main() {
  vec3 light = texelFetch(image, ivec2(gl_FragCoord.xy), 0).rgb;
  vec3 c = tone_mapped(light * scale);
  vec3 shown = vec3(srgb_byte(c.r), srgb_byte(c.g), srgb_byte(c.b)) / 255.0;
  color = vec4(any(isnan(light)) ? vec3(1, 0, 1) : shown, 1);
}
