// A surface into the geometry buffer, and what it shows without point and spot lights into the image: light passes
// only add to it.
//   GBUFFER_8, GBUFFER_16: the layout (common/gbuffer.glsl)
#include "shaders/common/surface.glsl"
#include "shaders/common/position.glsl"
#include "shared/brdf.h"
#include "shaders/common/own_light.glsl"
#include "shaders/common/gbuffer.glsl"

layout(location = 0) out vec4 radiance;
layout(location = 1) out vec4 normal_roughness_metallic;
layout(location = 2) out vec4 base_color_lit;

void main() {
  Surface s = surface_here();
#ifdef MASK
  if (has(MATERIAL_MASK) && s.alpha < material.alpha_cutoff) discard;
#endif
  GBufferTexels texels = gbuffer_texels(LitSurface(s.normal, s.base_color, s.metallic, s.roughness, !s.unlit));
  normal_roughness_metallic = texels.normal_roughness_metallic;
  base_color_lit = texels.base_color_lit;
  vec3 color = s.base_color;
#ifdef UNLIT
  if (!s.unlit) {
#endif
    vec3 position = position_of_pixel(gl_FragCoord.xy, gl_FragCoord.z);
    vec3 to_viewer = direction_to_viewer(position);
    color = own_light(s, shading_point(position, to_viewer, s.normal, s.base_color, s.metallic, s.roughness));
#ifdef UNLIT
  }
#endif
  radiance = vec4(color, 1.0);
}
