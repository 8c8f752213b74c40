// Base lighting: what a surface shows without point and spot lights, the same bits in every technique. After
// shared/brdf.h.
#ifdef DIRECTIONAL
#include "shaders/lights/directional.glsl"
#endif
#include "shared/effects.h"
#define VALUE_OF_POINT(kind, type, name, resource) , p.surface.name
#define ADD_BASE(inputs, base, own) color += base(p, s.occlusion, true own(VALUE_OF_POINT));

vec3 base_lighting(Surface s, ShadingPoint p) {
  vec3 ambient = vec3(view.ambient_r, view.ambient_g, view.ambient_b);
  // Precise: otherwise fused multiply-adds could make the rounding depend on the rest of the program.
  precise vec3 own = UNDER_COAT(p, s.emissive) + ambient * AMBIENT_REFLECTANCE(p) * s.occlusion;
  vec3 color = own;
#ifdef DIRECTIONAL
  color += directional_light_sum(p);
#endif
  BASE_EFFECTS(ADD_BASE)
  return color;
}
