// The depth prepass writes depth alone; masked surfaces first test their mask.
// LIMIT: the radiance that may lie behind a blended surface whose alpha is 1: src/engine/passes/shade_forward.cpp.
//   GROUP_LOCATION: as in gbuffer.frag
//   MASKS_OF_CENTRES: shaders/common/material.glsl
#if defined(LIMIT) || defined(MASK)
#include "shaders/common/material.glsl"
#endif

#ifdef GROUP_LOCATION
layout(location = GROUP_LOCATION) out uint group_number;
uniform uint group_number_of_draw;
#define WRITE_GROUP group_number = group_number_of_draw;
#else
#define WRITE_GROUP
#endif

#if defined(LIMIT)
#include "shared/shading_point.h"

layout(location = 0) out vec4 limit;

void main() {
  if (material_base_color().a < 1.0) discard;
  limit = vec4(LARGEST_BLENDED);
}
#elif defined(MASK)
void main() {
  apply_mask(material_base_color().a);
  WRITE_GROUP
}
#else
void main() { WRITE_GROUP }
#endif
