// The volume of a light and its index.
#include "shaders/common/light_volume.glsl"
#include "shaders/common/light_index.glsl"

flat out vec4 channels[LIDR_TARGETS];

void main() {
  place_corner();
  for (uint target = 0u; target < uint(LIDR_TARGETS); ++target)
    channels[target] = channels_of(light_of_volume + 1u, target);
}
