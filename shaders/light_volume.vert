// The volume of a light, for its light or for marking what is inside.
#include "shaders/common/light_volume.glsl"

flat out uint light;

void main() {
  place_corner();
  light = light_of_volume;
}
