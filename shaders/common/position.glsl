// A pixel's position in view space from its depth.
#include "shared/pixel_position.h"

vec3 position_of_pixel(vec2 pixel, float depth) { return position_of_pixel(pixel.x, pixel.y, depth); }
