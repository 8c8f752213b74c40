// The models of a scene's materials by number (scene/material_model.h), as shaders and kernels read them:
// two vectors of four floats each.
#pragma once

#include "shared/language.h"

#define MOST_MODELS 254  // other than Lambert's: numbers 1 to 254 of a geometry buffer's channel of 8 bits

#if defined(LIGHTGRID_GLSL)
struct MaterialModelRecord {
  vec4 subsurface;  // colour; roll-off
  vec4 minnaert;    // k; three unused
};
layout(std140) uniform MaterialModelsBlock { MaterialModelRecord of[MOST_MODELS + 1]; }
material_models;
#else
#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif
typedef struct MaterialModelRecord {
  float subsurface[3], roll_off;
  float minnaert_k, spare[3];
} MaterialModelRecord;
#if !defined(__OPENCL_VERSION__)
}  // namespace lightgrid
#endif
#endif
