#include "renderer/model_records.h"

#include <algorithm>
#include <cstring>

namespace lightgrid {

std::vector<MaterialModelRecord> model_records(const Scene& scene) {
  const std::vector<MaterialModel> models = material_models(scene);
  std::vector<MaterialModelRecord> records(MOST_MODELS + 1,
                                           {.subsurface = {}, .roll_off = 0, .minnaert_k = 1, .spare = {}});
  for (size_t i = 0; i < std::min(models.size(), records.size()); ++i) {
    std::memcpy(records[i].subsurface, &models[i].subsurface_color, sizeof records[i].subsurface);
    records[i].roll_off = models[i].roll_off, records[i].minnaert_k = models[i].minnaert_k;
  }
  return records;
}

}  // namespace lightgrid
