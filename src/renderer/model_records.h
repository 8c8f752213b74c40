// The models of a scene's materials as shaders and kernels read them.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/model_records.h"

namespace lightgrid {

// By number. MOST_MODELS + 1 records, whatever the scene has: those without a model are Lambert's, so that no
// number that a kernel reads past the end of an image is past the end of the table. Models past MOST_MODELS
// are left out.
std::vector<MaterialModelRecord> model_records(const Scene& scene);

}  // namespace lightgrid
