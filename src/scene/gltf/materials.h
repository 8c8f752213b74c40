// Materials, and the textures that the scene's meshes need of them.
#pragma once

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// All of the file's materials, then glTF's default one. The slots hold the file's texture indices, checked.
std::vector<Material> read_materials(Document& doc);

// Drops the materials that no mesh of the scene uses.
void keep_used_materials(Scene& scene);

// The image of a texture: the one of EXT_texture_webp (2021), else its source; -1: it has none that is supported.
int image_of_texture(const Document& doc, int texture);

// Fills scene.textures and scene.bitmaps with what its materials name, and turns the slots' indices to these.
// Each image is decoded once, in parallel; see images.h.
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
                                             {&Material::emissive_map, true}};

}  // namespace lightgrid::gltf
