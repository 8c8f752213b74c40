// The lobe of all materials, and diffuse models besides Lambert's, chosen by a material: skin and Minnaert
// (docs/material_models.md).
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

struct Scene;

// Skin adds light that enters at the surface and leaves it nearby (lambSkin of NVIDIA's SDK 9.5); Minnaert
// replaces the cosines of the diffuse part (Minnaert 1941, in the form of Engel, ShaderX7, 2009, appendix
// of 8.5).
struct MaterialModel {
  glm::vec3 subsurface_color{0};  // linear
  float roll_off = 0;    // 0 to 1: the cosine behind the terminator at which skin turns dark; 0: no skin
  float minnaert_k = 1;  // above 0, to 2; 1: Lambert

  bool skin() const { return roll_off > 0 && subsurface_color != glm::vec3(0); }
  bool minnaert() const { return minnaert_k != 1; }
  bool operator==(const MaterialModel&) const = default;
};

// The distinct models of the scene's lit materials by number. Number 0 is Lambert's; the others follow in the
// order of the materials.
std::vector<MaterialModel> material_models(const Scene& scene);

// The number of a model. It is one of `models`.
int model_number(const std::vector<MaterialModel>& models, const MaterialModel& model);

enum class Brdf { ggx, blinn, lambert };  // the specular lobe, or none: shared/brdf.h

}  // namespace lightgrid
