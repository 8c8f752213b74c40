// Lights on the surfaces of the geometry buffer, to be added to the image: one light, or a range of lights.
//   LIGHT_VOLUME: the light comes with its volume (light_volume.vert), else as a uniform
//   LIGHT_RANGE: instead all lights of `light_range`, first to end - 1, in one sum
//   DEPTH_BOUNDS: nothing outside an interval of depth
//   EARLY_TESTS: the stencil has masks of surfaces: it is tested, and its mark reset, before a pixel is shaded
//   MARK: instead of light, the pair (pixel, light): a digit of base 4 for each of 48 lights, 12 a channel,
//     so that sums are exact and count the invocations; with SAMPLES at centres
//   GBUFFER_8, GBUFFER_16, CLEARCOAT, SPECULAR, SKIN, MINNAERT: the layout (shared/gbuffer.h)
#ifdef MARK
#define AT_CENTRES
#endif
#include "shaders/common/read_gbuffer.glsl"
#include "shared/brdf.h"
#include "shaders/lights/punctual.glsl"
#include "shaders/common/surface_of_pixel.glsl"

#ifdef LIGHT_VOLUME
flat in uint light;
#elif defined(LIGHT_RANGE)
uniform uvec2 light_range;
#else
uniform uint light;
#endif
#ifdef DEPTH_BOUNDS
uniform vec2 depth_bounds;
#endif
#ifdef MARK
uniform uint first_light;
#endif

layout(location = 0) out vec4 added;
#ifdef EARLY_TESTS
layout(early_fragment_tests) in;
#endif

#ifdef MARK
vec4 mark() {
  uint place = light - first_light;
  vec4 digits = vec4(0.0);
  digits[place / 12u] = float(1u << (2u * (place % 12u)));
  return digits;
}
#endif

// Everything about the surface that the light's direction does not change.
ShadingPoint point_of_pixel(ivec2 pixel, vec3 position, LitSurface s) {
  vec3 to_viewer = direction_to_viewer(position);
  ShadingPoint p = shading_point(position, to_viewer, s.normal, s.base_color, s.metallic, s.roughness);
#ifdef SPECULAR
  Specular specular = specular_of_pixel(pixel);
  p = with_specular(p, s.metallic, specular.f0, specular.f90);
#endif
#ifdef SKIN
  vec4 skin = material_models.of[int(s.model)].subsurface;
  p = with_skin(p, skin.rgb, skin.a);
#endif
#ifdef MINNAERT
  p = with_minnaert(p, to_viewer, material_models.of[int(s.model)].minnaert.x);
#endif
#ifdef CLEARCOAT
  Coat coat = coat_of_pixel(pixel, s.normal);
  p = with_coat(p, coat.normal, coat.factor, coat.roughness);
#endif
  return p;
}

vec3 radiance_from(PunctualLight from, Arrival arrival, vec3 position, SurfaceValues surface, ShadingPoint p) {
  arrival.attenuation *= light_reaches(from, position, arrival.to_light, surface);
  TINT(arrival, from, position, surface)
  return radiance_of(p, arrival, from);
}

bool is_met(uint light, SurfaceValues surface) {
#ifdef MET_BY_EFFECTS
  return effects_meet(int(light), surface);
#else
  return true;
#endif
}

#ifdef LIGHT_RANGE
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  LitSurface s = surface_of_pixel(pixel);
  if (!s.lit) discard;
  vec3 position = position_of_pixel(place_of_sample(), texelFetch(depth_image, pixel, SAMPLE_HERE).r);
  SurfaceValues surface = values_of_pixel(pixel);
  ShadingPoint p = point_of_pixel(pixel, position, s);
  vec3 sum = vec3(0.0);
  for (uint light = light_range.x; light < light_range.y; ++light) {
    if (!is_met(light, surface)) continue;
    PunctualLight from = light_at(int(light));
    Arrival arrival = arrival_at(position, from);
    if (arrival.attenuation > 0.0) sum += radiance_from(from, arrival, position, surface, p);
  }
  added = vec4(sum, 0.0);
}
#else
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depth_image, pixel, SAMPLE_HERE).r;
#ifdef DEPTH_BOUNDS
  if (depth < depth_bounds.x || depth > depth_bounds.y) discard;
#endif
#ifdef MARK
  added = mark();
#else
  PunctualLight from = light_at(int(light));
  SurfaceValues surface = values_of_pixel(pixel);
  if (!is_met(light, surface)) discard;
  vec3 position = position_of_pixel(place_of_sample(), depth);
  Arrival arrival = arrival_at(position, from);
  if (!(arrival.attenuation > 0.0)) discard;  // would add an exact zero
  LitSurface s = surface_of_pixel(pixel);
  if (!s.lit) discard;
  added = vec4(radiance_from(from, arrival, position, surface, point_of_pixel(pixel, position, s)), 0.0);
#endif
}
#endif
