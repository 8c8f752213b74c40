// Materials, and the textures that the scene's materials use.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// The file's materials by its index, then glTF's default one. The slots hold texture indices of the file,
// checked. A material that no mesh of the nodes uses is not read: it is a default one.
std::vector<Material> read_materials(Document& doc, const std::vector<PlacedNode>& nodes);

// Drops the materials that no mesh of the scene uses.
void keep_used_materials(Scene& scene);

// The image of a texture: from EXT_texture_webp (2021), else its source; -1 if neither is supported.
int image_of_texture(const Document& doc, int texture);

// Fills scene.textures and scene.bitmaps with those that its materials use, and converts the slots' indices
// to them. Each image is decoded once, in parallel.
void add_textures(Document& doc, Scene& scene);

// The slots of a material, and whether each holds colours.
struct SlotUse {
  TextureSlot Material::*slot;
  bool srgb;
};
inline constexpr SlotUse material_slots[] = {{&Material::base_color_map, true},
                                             {&Material::metallic_roughness_map, false},
                                             {&Material::normal_map, false},
                                             {&Material::occlusion_map, false},
                                             {&Material::emissive_map, true},
                                             {&Material::clearcoat_map, false},
                                             {&Material::clearcoat_roughness_map, false},
                                             {&Material::clearcoat_normal_map, false},
                                             {&Material::specular_map, false},
                                             {&Material::specular_color_map, true}};

}  // namespace lightgrid::gltf
