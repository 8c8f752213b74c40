// The surface at a point, in double: shaded by the oracle, read by the terms of effects (plan/effect.h).
#pragma once

#include <glm/glm.hpp>

#include "scene/effect_terms.h"

namespace lightgrid {

struct Surface {
  glm::dvec3 normal{0, 0, 1};  // view space, unit; the shading normal
  glm::dvec3 base_color{1}, emissive{0};
  double metallic = 0, roughness = 1;  // perceptual roughness; floored at 0.045
  double occlusion = 1;
  bool unlit = false;  // base_color is the result
  // Reflectance of the dielectric part at normal and grazing incidence (KHR_materials_specular,
  // KHR_materials_ior).
  glm::dvec3 f0{0.04};  // for an index of refraction of 1.5
  double f90 = 1;
  double coat = 0, coat_roughness = 0;  // factor, 0: no coat; perceptual roughness, floored likewise
  glm::dvec3 coat_normal{0, 0, 1};      // as normal
  glm::dvec3 subsurface_color{0};       // only for skin (scene/material_model.h)
  double roll_off = 0, minnaert_k = 1;
  uint32_t mask = full_mask;  // only lights whose mask shares a bit light it
};

}  // namespace lightgrid
