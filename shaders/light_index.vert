// The volume of a light and its index.
//   INDEX_SHADOWS: also passes on the light's number
#include "shaders/common/light_volume.glsl"
#include "shaders/common/light_index.glsl"

flat out vec4 channels[LIDR_TARGETS];
#ifdef INDEX_SHADOWS
flat out uint light;
#endif

void main() {
  place_corner();
#ifdef INDEX_SHADOWS
  light = light_of_volume;
#endif
  for (uint target = 0u; target < uint(LIDR_TARGETS); ++target)
    channels[target] = channels_of(light_of_volume + 1u, target);
}
