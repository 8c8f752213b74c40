// A separate index at each pixel, to test this machine's blending.
#include "shaders/common/light_index.glsl"

uniform usampler2D indices;
layout(location = 0) out vec4 images[LIDR_TARGETS];

void main() {
  uint index = texelFetch(indices, ivec2(gl_FragCoord.xy), 0).r;
  for (uint target = 0u; target < uint(LIDR_TARGETS); ++target) images[target] = channels_of(index, target);
}
