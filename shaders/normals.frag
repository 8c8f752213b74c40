// The prepass of light_prepass: depth, and the normal that lights meet.
//   NORMALS_OCTAHEDRAL, NORMALS_SPHEREMAP, NORMALS_XYZ8: the format (shared/stored_normal.h); without, floats
//   PREPASS_STORED: the fourth channel is the perceptual roughness
#include "shaders/common/surface.glsl"
#include "shared/stored_normal.h"

layout(location = 0) out vec4 stored;
//   NUMBER_LOCATION: as in gbuffer.frag
#ifdef NUMBER_LOCATION
layout(location = NUMBER_LOCATION) out uint surface_number;
#include "shaders/common/number_of_draw.glsl"
#endif

void main() {
#ifdef MASK
  apply_mask(material_base_color().a);
#endif
  vec3 normal = shading_normal();
#ifdef NORMAL_CHANNEL_STEPS
  normal = steps_of_normal(normal) / NORMAL_CHANNEL_STEPS;
#endif
#ifdef PREPASS_STORED
  stored = vec4(normal, roughness_metallic_here().x);
#else
  stored = vec4(normal, 0.0);
#endif
#ifdef NUMBER_LOCATION
  surface_number = surface_number_of_draw;
#endif
}
