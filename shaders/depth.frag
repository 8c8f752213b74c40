// The depth prepass writes depth alone; masked surfaces first test their mask.
#ifdef MASK
#include "shaders/common/material.glsl"

void main() {
  if (has(MATERIAL_MASK) && material_base_color().a < material.alpha_cutoff) discard;
}
#else
void main() {}
#endif
