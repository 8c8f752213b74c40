// The share of one light that is hidden at each pixel, as light index images or shading have it: for the
// oracle.
#include "shaders/common/position.glsl"
#include "shaders/common/receiver.glsl"
#include "shaders/common/index_shadow.glsl"

uniform uint light;
uniform sampler2D depth_image;
layout(location = 0) out float hidden;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 position = position_of_pixel(gl_FragCoord.xy, texelFetch(depth_image, pixel, 0).r);
  hidden = hidden_share(light, receiver_at(pixel, position), pixel);
#ifdef LIDR_SHARE_BITS
  hidden = float(steps_of_share(hidden)) / share_steps;
#endif
}
