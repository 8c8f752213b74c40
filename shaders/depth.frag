// The depth prepass writes depth alone; masked surfaces first test their mask.
// LIMIT: the radiance that may lie behind a blended surface whose alpha is 1: src/engine/passes/shade_forward.cpp.
//   NUMBER_LOCATION: as in gbuffer.frag
//   MASKS_OF_CENTRES: shaders/common/material.glsl
#if defined(LIMIT) || defined(MASK)
#include "shaders/common/material.glsl"
#endif

#ifdef NUMBER_LOCATION
layout(location = NUMBER_LOCATION) out uint surface_number;
#include "shaders/common/number_of_draw.glsl"
#define WRITE_NUMBER surface_number = surface_number_of_draw;
#else
#define WRITE_NUMBER
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
  WRITE_NUMBER
}
#else
void main() { WRITE_NUMBER }
#endif
