// Writes a light's index into the light index images; the packing's blending combines it with earlier ones.
//   INDEX_SHADOWS: writes nothing where the light is hidden (common/index_shadow.glsl)
//   LIDR_SHARE_BITS: writes its hidden share beside the index, and nothing where all of it is hidden
flat in vec4 channels[LIDR_TARGETS];

layout(location = 0) out vec4 images[LIDR_TARGETS];

#ifdef INDEX_SHADOWS
#include "shaders/common/position.glsl"
#include "shaders/common/receiver.glsl"
#include "shaders/common/index_shadow.glsl"
#include "shaders/common/light_index.glsl"

flat in uint light;
uniform sampler2D depth_image;

float hidden_here() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 position = position_of_pixel(gl_FragCoord.xy, texelFetch(depth_image, pixel, 0).r);
  return hidden_share(light, receiver_at(pixel, position), pixel);
}
#endif

void main() {
#if defined(INDEX_SHADOWS) && defined(LIDR_SHARE_BITS)
  uint steps = steps_of_share(hidden_here());
  if (float(steps) == share_steps) discard;
  for (uint target = 0u; target < uint(LIDR_TARGETS); ++target)
    images[target] = channels_of((light + 1u) | steps << LIDR_SHARE_SHIFT, target);
#else
#ifdef INDEX_SHADOWS
  if (hidden_here() > 0.5) discard;
#endif
  images = channels;
#endif
}
