// Which light code a shading program holds.
#pragma once

#include "passes/object_lights.h"
#include "passes/passes.h"

namespace lightgrid {

// Binds the lights, and the textures through which a pixel finds its own.
inline void bind_lights(Frame& f, const GridTextures* grid) {
  f.bind_lights();
  if (!grid) return;
  glBindTextureUnit(12, grid->masks ? grid->masks : grid->cells);
  glBindTextureUnit(13, grid->indices);
  if (grid->z_bins) glBindTextureUnit(14, grid->z_bins);
}

inline void bind_lights(Frame& f, const LightIndexImages& index) {
  f.bind_lights();
  for (size_t i = 0; i < index.images.size(); ++i) glBindTextureUnit(GLuint(12 + i), index.images[i]);
}

inline void bind_lights(Frame& f, const ObjectLights& objects) {
  f.bind_lights();
  if (objects.texture()) glBindTextureUnit(12, objects.texture());
}

// Without point and spot lights.
inline std::vector<std::string> own_light_defines(const Frame& f, uint32_t features) {
  std::vector<std::string> defines = defines_of(features);
  if (f.plan.settings.brdf == Brdf::blinn) defines.emplace_back("BLINN");
  if (f.plan.directional) defines.emplace_back("DIRECTIONAL");
  return defines;
}

inline std::vector<std::string> light_defines(const Frame& f, uint32_t features) {
  std::vector<std::string> defines = own_light_defines(f, features);
  if (f.plan.local_lights) defines.emplace_back("LIGHTS");
  if (f.plan.spots) defines.emplace_back("SPOTS");
  return defines;
}

inline std::vector<std::string> light_defines(const Frame& f, uint32_t features, const GridTextures* grid) {
  std::vector<std::string> defines = light_defines(f, features);
  if (grid) defines.emplace_back(grid->masks ? "LIGHTS_MASKS" : "LIGHTS_GRID");
  if (grid && f.plan.slices > 1) defines.emplace_back("SLICES");
  if (grid && f.plan.z_bins > 1) defines.emplace_back("Z_BINS");
  return defines;
}

inline std::vector<std::string> light_defines(const Frame& f, uint32_t features, const ObjectLights&) {
  std::vector<std::string> defines = light_defines(f, features);
  defines.emplace_back("LIGHTS_OBJECT");
  return defines;
}

inline std::vector<std::string> light_defines(const Frame& f, uint32_t features, const LightIndexImages& index) {
  std::vector<std::string> defines = light_defines(f, features);
  defines.insert(defines.end(), index.defines.begin(), index.defines.end());
  return defines;
}

}  // namespace lightgrid
