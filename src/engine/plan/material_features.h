// The features that materials require of shaders and vertex streams.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/material_model.h"
#include "scene/scene.h"

namespace lightgrid {

// The features that a material requires of the shaders, as bits; each is one #define (defines_of).
enum MaterialFeature : uint32_t {
  feature_textured = 1,  // any map at all: first UV set
  feature_uv1 = 2,
  feature_uv_transform = 4,
  feature_vertex_color = 8,
  feature_base_color_map = 16,
  feature_metallic_roughness_map = 32,
  feature_normal_map = 64,
  feature_occlusion_map = 128,
  feature_emissive_map = 256,
  feature_mask = 512,
  feature_unlit = 1024,
  feature_clearcoat = 2048,
  feature_clearcoat_map = 4096,
  feature_clearcoat_roughness_map = 8192,
  feature_clearcoat_normal_map = 16384,
  feature_skin = 32768,
  feature_minnaert = 65536,
  feature_specular = 131072,
  feature_specular_map = 262144,
  feature_specular_color_map = 524288,
  feature_all = 1048575,
  // Base colour and alpha depend on these.
  features_of_base_color =
      feature_textured | feature_uv1 | feature_uv_transform | feature_vertex_color | feature_base_color_map,
};

// The features that shading with this BRDF reads: Lambert has no coat and no specular reflectance.
uint32_t features_read(uint32_t features, Brdf brdf);

struct FeatureName {
  uint32_t bit;
  const char* define;
  const char* effect;
};
extern const std::span<const FeatureName> feature_names;

std::vector<std::string> defines_of(uint32_t features);

// The features that a mesh with its material requires of shaders and vertex streams.
uint32_t material_features(const Scene& scene, const Mesh& mesh);

}  // namespace lightgrid
