#include "scene/material_model.h"

#include <algorithm>

#include "scene/scene.h"

namespace lightgrid {
namespace {

bool is_lambert(const MaterialModel& model) { return !model.skin() && !model.minnaert(); }

}  // namespace

std::vector<MaterialModel> material_models(const Scene& scene) {
  std::vector<MaterialModel> models(1);
  for (const Material& m : scene.materials) {
    if (m.unlit || is_lambert(m.model)) continue;
    if (std::find(models.begin(), models.end(), m.model) == models.end()) models.push_back(m.model);
  }
  return models;
}

int model_number(const std::vector<MaterialModel>& models, const MaterialModel& model) {
  if (is_lambert(model)) return 0;
  return int(std::find(models.begin(), models.end(), model) - models.begin());
}

}  // namespace lightgrid
