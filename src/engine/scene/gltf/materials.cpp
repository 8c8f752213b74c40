#include "scene/gltf/materials.h"

#include <algorithm>
#include <cmath>

namespace lightgrid::gltf {
namespace {

float finite(const Document& doc, double value, const std::string& place, const char* what) {
  const auto out = static_cast<float>(value);
  if (!std::isfinite(out)) throw doc.error("{}: {} is {}", place, what, value);
  return out;
}

// A small excess is an exporter's rounding.
float in_unit(const Document& doc, double value, const std::string& place, const char* what) {
  const float out = finite(doc, value, place, what);
  if (out < -1e-3f || out > 1 + 1e-3f) throw doc.error("{}: {} is {}, outside 0 to 1", place, what, value);
  return std::clamp(out, 0.0f, 1.0f);
}

float not_negative(const Document& doc, double value, const std::string& place, const char* what) {
  const float out = finite(doc, value, place, what);
  if (out < 0) throw doc.error("{}: {} is {}", place, what, value);
  return out;
}

glm::vec2 pair_or(const Document& doc, const tinygltf::Value& object, const char* key, glm::vec2 absent,
                  const std::string& place) {
  if (!object.Has(key)) return absent;
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber())
    throw doc.error("{}: {} is not a pair of numbers", place, key);
  return {finite(doc, value.Get(0).GetNumberAsDouble(), place, key),
          finite(doc, value.Get(1).GetNumberAsDouble(), place, key)};
}

// KHR_texture_transform: translation * rotation * scale. Counter-clockwise with v pointing down, as in the
// extension's sample model (the listing in its text turns the other way: Khronos glTF issue 1563).
void read_transform(Document& doc, const tinygltf::Value& extension, const std::string& place,
                    TextureSlot& slot, int& uv_set) {
  const glm::vec2 offset = pair_or(doc, extension, "offset", {0, 0}, place);
  const glm::vec2 scale = pair_or(doc, extension, "scale", {1, 1}, place);
  const double turn = number_or(doc, extension, "rotation", 0, place);
  const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
  slot.uv_from_vertex = {scale.x * c, -scale.x * s, scale.y * s, scale.y * c, offset.x, offset.y};
  uv_set = static_cast<int>(size_or(doc, extension, "texCoord", static_cast<size_t>(uv_set), place));
}

TextureSlot read_slot(Document& doc, const auto& info, const std::string& place) {
  if (info.index < 0) return {};
  checked(doc, doc.model.textures, info.index, place, "texture");
  if (image_of_texture(doc, info.index) < 0) {
    doc.warn("texture without image", "{}: texture {} has no image that is supported; left out", place,
             info.index);
    return {};
  }
  TextureSlot slot{.texture = info.index};
  int uv_set = info.texCoord;
  if (const auto* transform = find_extension(info.extensions, "KHR_texture_transform"))
    read_transform(doc, *transform, place, slot, uv_set);
  slot.uv_set = uv_set;  // the file's number, until number_uv_sets
  return slot;
}

// Meshes have two sets. A material that uses others has its first two in their place.
void number_uv_sets(Document& doc, int index, const std::string& place, Material& material) {
  std::vector<int> sets;
  for (const SlotUse& use : material_slots) {
    const TextureSlot& slot = material.*use.slot;
    if (slot.texture >= 0 && std::ranges::find(sets, slot.uv_set) == sets.end()) sets.push_back(slot.uv_set);
  }
  if (std::ranges::all_of(sets, [](int set) { return set < 2; })) return;
  for (size_t i = 2; i < sets.size(); ++i)
    doc.warn("uv set",
             "{}: uses TEXCOORD_{} besides TEXCOORD_{} and _{}; its textures of a third set are left out",
             place, sets[i], sets[0], sets[1]);
  sets.resize(2, -1);
  if (sets[1] >= 0) std::ranges::sort(sets);
  for (const SlotUse& use : material_slots) {
    TextureSlot& slot = material.*use.slot;
    if (slot.texture < 0) continue;
    const auto set = std::ranges::find(sets, slot.uv_set);
    if (set == sets.end())
      slot = {};
    else
      slot.uv_set = static_cast<int>(set - sets.begin());
  }
  doc.uv_sets[index] = {sets[0], sets[1]};
}

// A texture of an extension, which tinygltf leaves as it is in the file.
struct ExtensionTexture {
  int index = -1, texCoord = 0;
  tinygltf::ExtensionMap extensions;
  double scale = 1;
};

ExtensionTexture read_extension_texture(const Document& doc, const tinygltf::Value& extension,
                                        const char* key, const std::string& place) {
  if (!extension.Has(key)) return {};
  const tinygltf::Value& in = extension.Get(key);
  const std::string at = place + ": " + key;
  if (!in.IsObject() || !in.Has("index")) throw doc.error("{}: is no texture with an index", at);
  ExtensionTexture out{.index = static_cast<int>(size_or(doc, in, "index", 0, at)),
                       .texCoord = static_cast<int>(size_or(doc, in, "texCoord", 0, at)),
                       .scale = number_or(doc, in, "scale", 1, at)};
  if (!in.Has("extensions")) return out;
  const tinygltf::Value& extensions = in.Get("extensions");
  if (!extensions.IsObject()) throw doc.error("{}: extensions is no object", at);
  for (const std::string& name : extensions.Keys()) out.extensions.emplace(name, extensions.Get(name));
  return out;
}

// An extension's array of numbers; unchanged if it is absent.
template <int count>
void read_numbers(const Document& doc, const tinygltf::Value& in, const char* key, const std::string& place,
                  float (*check)(const Document&, double, const std::string&, const char*),
                  glm::vec<count, float>& out) {
  if (!in.Has(key)) return;
  const tinygltf::Value& array = in.Get(key);
  const auto fault = [&] {
    return doc.error("{}: {} is not {} numbers", place, key, count == 3 ? "three" : "four");
  };
  if (!array.IsArray() || array.ArrayLen() != count) throw fault();
  for (int i = 0; i < count; ++i) {
    if (!array.Get(i).IsNumber()) throw fault();
    out[i] = check(doc, array.Get(i).GetNumberAsDouble(), place, key);
  }
}

// KHR_materials_clearcoat.
void read_clearcoat(Document& doc, const tinygltf::Value& in, const std::string& place, Material& out) {
  const auto factor = [&](const char* key) {
    return in_unit(doc, number_or(doc, in, key, 0, place), place, key);
  };
  const auto texture = [&](const char* key) { return read_extension_texture(doc, in, key, place); };
  out.clearcoat = factor("clearcoatFactor");
  out.clearcoat_roughness = factor("clearcoatRoughnessFactor");
  out.clearcoat_map = read_slot(doc, texture("clearcoatTexture"), place + ": clearcoatTexture");
  out.clearcoat_roughness_map =
      read_slot(doc, texture("clearcoatRoughnessTexture"), place + ": clearcoatRoughnessTexture");
  const ExtensionTexture normal = texture("clearcoatNormalTexture");
  out.clearcoat_normal_map = read_slot(doc, normal, place + ": clearcoatNormalTexture");
  out.clearcoat_normal_scale = finite(doc, normal.scale, place, "clearcoatNormalTexture.scale");
  if (out.clearcoat == 0)
    out.clearcoat_map = out.clearcoat_roughness_map = out.clearcoat_normal_map = {};  // not decoded
}

// KHR_materials_ior.
float read_ior(const Document& doc, const tinygltf::Value& in, const std::string& place) {
  const double ior = number_or(doc, in, "ior", 1.5, place);
  if (ior != 0 && !(ior >= 1)) throw doc.error("{}: ior is {}; it is 0, or 1 or more", place, ior);
  return finite(doc, ior, place, "ior");
}

// KHR_materials_specular.
void read_specular(Document& doc, const tinygltf::Value& in, const std::string& place, Material& out) {
  out.specular = in_unit(doc, number_or(doc, in, "specularFactor", 1, place), place, "specularFactor");
  read_numbers(doc, in, "specularColorFactor", place, not_negative, out.specular_color);
  const auto slot = [&](const char* key) {
    return read_slot(doc, read_extension_texture(doc, in, key, place), place + ": " + key);
  };
  out.specular_map = slot("specularTexture");
  out.specular_color_map = slot("specularColorTexture");
  if (out.specular == 0) out.specular_map = out.specular_color_map = {};  // not decoded
}

// A texture of the roughness 1 - glossiness * alpha.
int roughness_texture(Document& doc, int texture, float glossiness) {
  const auto [known, is_new] =
      doc.roughness_textures.try_emplace({texture, glossiness}, static_cast<int>(doc.model.textures.size()));
  if (!is_new) return known->second;
  const int source = image_of_texture(doc, texture);
  ImageEntry image = doc.images[size_t(source)];
  image.roughness = {source, glossiness};
  tinygltf::Texture made = doc.model.textures[size_t(texture)];
  made.extensions.clear();
  made.source = static_cast<int>(doc.images.size());
  doc.images.push_back(std::move(image));
  doc.model.textures.push_back(std::move(made));
  return known->second;
}

// KHR_materials_pbrSpecularGlossiness, converted as KHR_materials_specular states: a dielectric with an index
// of refraction of 0 reflects its specular colour at normal incidence.
void read_specular_glossiness(Document& doc, const tinygltf::Value& in, const std::string& place,
                              Material& out) {
  out.base_color = glm::vec4(1);
  out.specular_color = glm::vec3(1);
  out.metallic = 0;
  out.ior = 0;
  out.specular = 1;
  read_numbers(doc, in, "diffuseFactor", place, in_unit, out.base_color);
  read_numbers(doc, in, "specularFactor", place, in_unit, out.specular_color);
  const float glossiness =
      in_unit(doc, number_or(doc, in, "glossinessFactor", 1, place), place, "glossinessFactor");
  out.roughness = 1 - glossiness;
  const auto slot = [&](const char* key) {
    return read_slot(doc, read_extension_texture(doc, in, key, place), place + ": " + key);
  };
  out.base_color_map = slot("diffuseTexture");
  out.specular_map = {};
  out.metallic_roughness_map = out.specular_color_map = slot("specularGlossinessTexture");
  if (out.specular_color_map.texture < 0) return;
  out.roughness = 1;
  out.metallic_roughness_map.texture = roughness_texture(doc, out.specular_color_map.texture, glossiness);
}

// KHR_materials_transmission, as blending: what passes both faces of a thin pane is what is not reflected at
// normal incidence, and of that the mean of the base colour, since blending cannot tint what lies behind.
void read_transmission(Document& doc, const tinygltf::Value& in, const std::string& place, Material& out) {
  const float factor =
      in_unit(doc, number_or(doc, in, "transmissionFactor", 0, place), place, "transmissionFactor");
  if (factor == 0 || out.unlit) return;
  doc.warn(
      "transmission",
      "{}: KHR_materials_transmission is drawn as blending: without refraction, without blur behind rough "
      "surfaces, and with highlights as weak as the rest of the surface",
      place);
  if (in.Has("transmissionTexture"))
    doc.warn("transmissionTexture", "{}: transmissionTexture is left out; the factor is used everywhere",
             place);
  const float reflected = out.ior > 0 ? std::pow((out.ior - 1) / (out.ior + 1), 2.0f) : 1.0f;
  const float tint = (out.base_color.r + out.base_color.g + out.base_color.b) / 3;
  const float through = factor * (1 - out.metallic) * tint * (1 - reflected) * (1 - reflected);
  if (out.alpha_mode == AlphaMode::opaque) out.base_color.a = 1;
  out.base_color.a *= 1 - through;
  out.alpha_mode = AlphaMode::blend;
}

// NVIDIA's lambSkin has these; they stand in where the file names none.
constexpr glm::vec3 default_subsurface_color(1, 0.2f, 0.2f);
constexpr double default_roll_off = 0.2;

MaterialModel read_model(const Document& doc, const MaterialExtras& in, const std::string& place) {
  MaterialModel out;
  if (in.model == "skin") {
    if (in.k) throw doc.error("{}: k is given, but the model is skin", place);
    out.subsurface_color = default_subsurface_color;
    for (int i = 0; in.subsurface_color && i < 3; ++i)
      out.subsurface_color[i] = in_unit(doc, (*in.subsurface_color)[i], place, "subsurfaceColor");
    out.roll_off = in_unit(doc, in.roll_off.value_or(default_roll_off), place, "rollOff");
    return out;
  }
  if (in.model != "minnaert")
    throw doc.error("{}: model is \"{}\"; models are skin and minnaert", place, in.model);
  if (in.subsurface_color || in.roll_off)
    throw doc.error("{}: subsurfaceColor or rollOff is given, but the model is minnaert", place);
  if (!in.k) throw doc.error("{}: k is missing", place);
  out.minnaert_k = finite(doc, *in.k, place, "k");
  if (!(out.minnaert_k > 0 && out.minnaert_k <= 2))
    throw doc.error("{}: k is {}; it is above 0 and at most 2", place, *in.k);
  return out;
}

AlphaMode read_alpha_mode(const Document& doc, const std::string& mode, const std::string& place) {
  if (mode == "OPAQUE") return AlphaMode::opaque;
  if (mode == "MASK") return AlphaMode::mask;
  if (mode == "BLEND") return AlphaMode::blend;
  throw doc.error("{}: alphaMode is \"{}\"", place, mode);
}

Material read_material(Document& doc, const tinygltf::Material& in, const std::string& place) {
  const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
  Material out{.name = in.name};
  for (int i = 0; i < 4; ++i)
    out.base_color[i] = in_unit(doc, pbr.baseColorFactor.at(i), place, "baseColorFactor");
  out.metallic = in_unit(doc, pbr.metallicFactor, place, "metallicFactor");
  out.roughness = in_unit(doc, pbr.roughnessFactor, place, "roughnessFactor");
  double strength = 1;
  if (const auto* emissive = find_extension(in.extensions, "KHR_materials_emissive_strength"))
    strength =
        not_negative(doc, number_or(doc, *emissive, "emissiveStrength", 1, place), place, "emissiveStrength");
  for (int i = 0; i < 3; ++i) {
    // Values above 1 formally require the extension, but were common before it existed.
    const double factor = not_negative(doc, in.emissiveFactor.at(i), place, "emissiveFactor");
    out.emissive[i] = not_negative(doc, factor * strength, place, "emissive light");
  }
  out.normal_scale = finite(doc, in.normalTexture.scale, place, "normalTexture.scale");
  out.occlusion_strength = in_unit(doc, in.occlusionTexture.strength, place, "occlusionTexture.strength");
  out.base_color_map = read_slot(doc, pbr.baseColorTexture, place + ": baseColorTexture");
  out.metallic_roughness_map =
      read_slot(doc, pbr.metallicRoughnessTexture, place + ": metallicRoughnessTexture");
  out.normal_map = read_slot(doc, in.normalTexture, place + ": normalTexture");
  out.occlusion_map = read_slot(doc, in.occlusionTexture, place + ": occlusionTexture");
  out.emissive_map = read_slot(doc, in.emissiveTexture, place + ": emissiveTexture");
  out.alpha_mode = read_alpha_mode(doc, in.alphaMode, place);
  out.alpha_cutoff = not_negative(doc, in.alphaCutoff, place, "alphaCutoff");
  out.double_sided = in.doubleSided;
  out.unlit = find_extension(in.extensions, "KHR_materials_unlit") != nullptr;
  if (const auto* clearcoat = find_extension(in.extensions, "KHR_materials_clearcoat"))
    read_clearcoat(doc, *clearcoat, place, out);
  if (const auto* ior = find_extension(in.extensions, "KHR_materials_ior"))
    out.ior = read_ior(doc, *ior, place);
  if (const auto* specular = find_extension(in.extensions, "KHR_materials_specular"))
    read_specular(doc, *specular, place, out);
  if (const auto* glossy = find_extension(in.extensions, "KHR_materials_pbrSpecularGlossiness");
      glossy && !out.unlit)
    read_specular_glossiness(doc, *glossy, place, out);
  if (const auto* transmission = find_extension(in.extensions, "KHR_materials_transmission"))
    read_transmission(doc, *transmission, place, out);
  return out;
}

// The materials of all primitives of the nodes' meshes.
std::vector<char> used_materials(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes) {
  std::vector<char> used(model.materials.size(), 0);
  for (const PlacedNode& placed : nodes) {
    const int mesh = model.nodes[placed.node].mesh;
    if (mesh < 0 || placed.off) continue;
    for (const tinygltf::Primitive& primitive : model.meshes[mesh].primitives)
      if (primitive.material >= 0) used[primitive.material] = 1;
  }
  return used;
}

}  // namespace

std::vector<Material> read_materials(Document& doc, const std::vector<PlacedNode>& nodes) {
  const std::vector<char> used = used_materials(doc.model, nodes);
  std::vector<Material> out;
  for (size_t i = 0; i < used.size(); ++i) {
    const tinygltf::Material& material = doc.model.materials[i];
    const std::string place = label("material", static_cast<int>(i), material.name);
    out.push_back(used[i] ? read_material(doc, material, place) : Material());
    number_uv_sets(doc, static_cast<int>(i), place, out.back());
  }
  for (const auto& [index, extras] : doc.extras.materials) {
    Material& material = out[size_t(index)];
    if (used[size_t(index)])
      material.model =
          read_model(doc, extras, label("material", index, material.name) + ": extras.lightgrid");
  }
  out.push_back({.name = "default"});
  return out;
}

void keep_used_materials(Scene& scene) {
  std::vector<int> new_index(scene.materials.size(), -1);
  for (const Mesh& mesh : scene.meshes) new_index[mesh.material] = 0;
  std::vector<Material> kept;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (new_index[i] < 0) continue;
    new_index[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(scene.materials[i]));
  }
  scene.materials = std::move(kept);
  for (Mesh& mesh : scene.meshes) mesh.material = new_index[mesh.material];
}

}  // namespace lightgrid::gltf
