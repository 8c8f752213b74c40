#include "plan/material_features.h"

namespace lightgrid {

static constexpr FeatureName names[] = {
    {feature_textured, "TEXTURED", "textures"},
    {feature_uv1, "UV1", "second UV set"},
    {feature_uv_transform, "UV_TRANSFORM", "texture transforms"},
    {feature_vertex_color, "VERTEX_COLOR", "vertex colours"},
    {feature_base_color_map, "BASE_COLOR_MAP", "base colour maps"},
    {feature_metallic_roughness_map, "METALLIC_ROUGHNESS_MAP", "metallic-roughness maps"},
    {feature_normal_map, "NORMAL_MAP", "normal maps"},
    {feature_occlusion_map, "OCCLUSION_MAP", "occlusion maps"},
    {feature_emissive_map, "EMISSIVE_MAP", "emissive maps"},
    {feature_mask, "MASK", "alpha masks"},
    {feature_unlit, "UNLIT", "unlit materials"},
    {feature_clearcoat, "CLEARCOAT", "clearcoat"},
    {feature_clearcoat_map, "CLEARCOAT_MAP", "clearcoat maps"},
    {feature_clearcoat_roughness_map, "CLEARCOAT_ROUGHNESS_MAP", "clearcoat roughness maps"},
    {feature_clearcoat_normal_map, "CLEARCOAT_NORMAL_MAP", "clearcoat normal maps"},
    {feature_skin, "SKIN", "skin"},
    {feature_minnaert, "MINNAERT", "Minnaert"},
    {feature_specular, "SPECULAR", "specular reflectance"},
    {feature_specular_map, "SPECULAR_MAP", "specular maps"},
    {feature_specular_color_map, "SPECULAR_COLOR_MAP", "specular colour maps"},
};

const std::span<const FeatureName> feature_names = names;

std::vector<std::string> defines_of(uint32_t features) {
  std::vector<std::string> defines;
  for (const FeatureName& f : feature_names) {
    if (features & f.bit) defines.emplace_back(f.define);
  }
  return defines;
}

uint32_t features_read(uint32_t features, Brdf brdf) {
  constexpr uint32_t of_lobes = feature_clearcoat | feature_clearcoat_map | feature_clearcoat_roughness_map |
                                feature_clearcoat_normal_map | feature_specular | feature_specular_map |
                                feature_specular_color_map;
  return brdf == Brdf::lambert ? features & ~of_lobes : features;
}

uint32_t material_features(const Scene& scene, const Mesh& mesh) {
  const Material& m = scene.materials[mesh.material];
  uint32_t features = 0;
  const auto use = [&](const TextureSlot& slot, uint32_t feature) {
    if (slot.texture < 0) return;
    features |= feature | feature_textured;
    if (slot.uv_set == 1) features |= feature_uv1;
    if (slot.transformed()) features |= feature_uv_transform;
  };
  use(m.base_color_map, feature_base_color_map);
  if (!mesh.colors.empty()) features |= feature_vertex_color;
  if (m.alpha_mode == AlphaMode::mask) features |= feature_mask;
  if (m.unlit) return features | feature_unlit;  // unlit surfaces need none of the features below
  use(m.metallic_roughness_map, feature_metallic_roughness_map);
  use(m.normal_map, feature_normal_map);
  use(m.occlusion_map, feature_occlusion_map);
  use(m.emissive_map, feature_emissive_map);
  if (m.model.skin()) features |= feature_skin;
  if (m.model.minnaert()) features |= feature_minnaert;
  if (has_specular(m)) {
    features |= feature_specular;
    use(m.specular_map, feature_specular_map);
    use(m.specular_color_map, feature_specular_color_map);
  }
  if (m.clearcoat == 0) return features;
  features |= feature_clearcoat;
  use(m.clearcoat_map, feature_clearcoat_map);
  use(m.clearcoat_roughness_map, feature_clearcoat_roughness_map);
  use(m.clearcoat_normal_map, feature_clearcoat_normal_map);
  return features;
}

}  // namespace lightgrid
