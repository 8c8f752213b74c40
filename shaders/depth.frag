// The depth prepass writes depth alone; masked surfaces first test their mask.
// LIMIT: the radiance that may lie behind a blended surface whose alpha is 1: src/passes/shade_forward.cpp.
#if defined(LIMIT) || defined(MASK)
#include "shaders/common/material.glsl"
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
  if (has(MATERIAL_MASK) && material_base_color().a < material.alpha_cutoff) discard;
}
#else
void main() {}
#endif
