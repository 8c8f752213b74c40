// One light's part in the light buffer, to be added to it: light_prepass with prepass-lights=volumes.
//   LIGHT_VOLUME, DEPTH_BOUNDS: as in deferred_light.frag
//   EARLY_TESTS: as in deferred_light.frag
//   NORMALS_…: the format of normals; LIGHT_EXPONENT: the lights' shininess (shared/light_buffer.h)
//   LIGHT_SCALE: a sum of this size is stored as 1
//   PREPASS_FIFTH_TERM: there is a second image
//   PREPASS_STORED: the exponent is that of the roughness next to the normal
#include "shaders/common/per_sample.glsl"
#include "shaders/common/position.glsl"
#include "shared/light_buffer.h"
#include "shared/stored_normal.h"
#include "shaders/lights/punctual.glsl"
#include "shaders/common/surface_of_pixel.glsl"

uniform frame_sampler2D normals;
uniform frame_sampler2D depth_image;
#ifdef LIGHT_VOLUME
flat in uint light;
#else
uniform uint light;
#endif
#ifdef DEPTH_BOUNDS
uniform vec2 depth_bounds;
#endif

layout(location = 0) out vec4 diffuse_specular;
#ifdef PREPASS_FIFTH_TERM
layout(location = 1) out vec2 weight_rim;
#endif

#ifdef EARLY_TESTS
layout(early_fragment_tests) in;
#endif

vec3 normal_of_texel(vec4 stored) {
#ifdef NORMAL_CHANNEL_STEPS
  return normal_of_steps(floor(stored.xyz * NORMAL_CHANNEL_STEPS + 0.5));
#else
  return stored.xyz;
#endif
}

float exponent_of_texel(vec4 stored) {
#ifdef PREPASS_STORED
  return shininess_of_roughness(stored.w);
#else
  return LIGHT_EXPONENT;
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depth_image, pixel, SAMPLE_HERE).r;
#ifdef DEPTH_BOUNDS
  if (depth < depth_bounds.x || depth > depth_bounds.y) discard;
#endif
  if (!(depth > 0.0)) discard;
  PunctualLight from = light_at(int(light));
  SurfaceValues surface = values_of_pixel(pixel);
#ifdef MET_BY_EFFECTS
  if (!effects_meet(int(light), surface)) discard;
#endif
  vec3 position = position_of_pixel(place_of_sample(), depth);
  Arrival arrival = arrival_at(position, from);
  if (!(arrival.attenuation > 0.0)) discard;  // would add exact zeros
  arrival.attenuation *= light_reaches(from, position, arrival.to_light, surface);
  TINT(arrival, from, position, surface)
  vec4 stored = texelFetch(normals, pixel, SAMPLE_HERE);
  LightTerms terms = terms_at(position, normal_of_texel(stored), direction_to_viewer(position), arrival, from,
                              exponent_of_texel(stored));
  diffuse_specular = vec4(terms.diffuse, terms.specular) * (1.0 / LIGHT_SCALE);
#ifdef PREPASS_FIFTH_TERM
  weight_rim = vec2(terms.weight, terms.rim) * (1.0 / LIGHT_SCALE);
#endif
}
