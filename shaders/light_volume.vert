// The volume of a light, for shading it or for marking its inside.
#include "shaders/common/light_volume.glsl"

flat out uint light;

void main() {
  place_corner();
  light = light_of_volume;
}
