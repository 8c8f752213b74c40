// The picture of a window (src/apps/view): the left image left of the line, the right image from there on.
#include "shared/film_curve.h"

uniform sampler2D left_image;   // linear RGB
uniform sampler2D right_image;

uniform vec2 size;        // the picture's size, pixels
uniform float line;       // pixels from its left
uniform int mapped_left;  // 1: colours of a map, without tone mapping
uniform int mapped_right;
uniform float exposure;     // for pictures, before the tone map
uniform int filmic;         // 1: the tone map is the filmic curve
uniform float map_opacity;  // for maps, over what is drawn already

layout(location = 0) out vec4 color;

// Images of another size are scaled.
vec3 image_at(sampler2D image, vec2 place) {
  if (ivec2(size) == textureSize(image, 0)) return texelFetch(image, ivec2(place), 0).rgb;
  return texture(image, place / size).rgb;
}

vec3 srgb(vec3 linear) {
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
             lessThanEqual(linear, vec3(0.0031308)));
}

vec3 tone_map(vec3 light) { return filmic != 0 ? film_mapped(light) : tone_mapped(light); }

void main() {
  bool left = gl_FragCoord.x < line;
  vec3 linear = left ? image_at(left_image, gl_FragCoord.xy) : image_at(right_image, gl_FragCoord.xy);
  bool mapped = (left ? mapped_left : mapped_right) != 0;
  bool is_nan = any(isnan(linear));
  vec3 shown = srgb(clamp(mapped ? linear : tone_map(exposure * linear), 0.0, 1.0));
  color = vec4(is_nan && !mapped ? vec3(1, 0, 1) : shown, mapped ? map_opacity : 1.0);
}
