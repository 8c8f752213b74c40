#include "scene/gltf/validate.h"

#include <algorithm>

#include "scene/gltf/materials.h"

namespace lightgrid::gltf {
namespace {

class Checker {
 public:
  explicit Checker(const Document& doc) : doc_(doc) {}

  void set_place(const char* kind, size_t index) { place_ = fmt::format("{} {}", kind, index); }
  void inside(const std::string& part) { place_ += " " + part; }

  void required(int index, size_t count, const char* what) const {
    if (index < 0 || static_cast<size_t>(index) >= count)
      throw doc_.error("{}: {} is {}, but there are {}", place_, what, index, count);
  }

  void optional(int index, size_t count, const char* what) const {
    if (index != -1) required(index, count, what);
  }

 private:
  const Document& doc_;
  std::string place_;
};

void check_accessors(const tinygltf::Model& model, Checker& check) {
  for (size_t i = 0; i < model.accessors.size(); ++i) {
    const tinygltf::Accessor& accessor = model.accessors[i];
    check.set_place("accessor", i);
    check.optional(accessor.bufferView, model.bufferViews.size(), "bufferView");
    if (!accessor.sparse.isSparse) continue;
    check.required(accessor.sparse.indices.bufferView, model.bufferViews.size(), "sparse.indices.bufferView");
    check.required(accessor.sparse.values.bufferView, model.bufferViews.size(), "sparse.values.bufferView");
  }
}

void check_meshes(const tinygltf::Model& model, Checker& check) {
  for (size_t i = 0; i < model.meshes.size(); ++i) {
    for (size_t p = 0; p < model.meshes[i].primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = model.meshes[i].primitives[p];
      check.set_place("mesh", i);
      check.inside(fmt::format("primitive {}", p));
      check.optional(primitive.indices, model.accessors.size(), "indices");
      check.optional(primitive.material, model.materials.size(), "material");
      for (const auto& [name, accessor] : primitive.attributes)
        check.required(accessor, model.accessors.size(), name.c_str());
      for (const auto& target : primitive.targets)
        for (const auto& [name, accessor] : target)
          check.required(accessor, model.accessors.size(), ("target " + name).c_str());
    }
  }
}

void check_nodes(const tinygltf::Model& model, Checker& check) {
  for (size_t i = 0; i < model.nodes.size(); ++i) {
    const tinygltf::Node& node = model.nodes[i];
    check.set_place("node", i);
    check.optional(node.mesh, model.meshes.size(), "mesh");
    check.optional(node.skin, model.skins.size(), "skin");
    check.optional(node.camera, model.cameras.size(), "camera");
    for (int child : node.children) check.required(child, model.nodes.size(), "child");
    const tinygltf::Value* instanced = find_extension(node.extensions, "EXT_mesh_gpu_instancing");
    if (!instanced || !instanced->Has("attributes") || !instanced->Get("attributes").IsObject()) continue;
    for (const std::string& name : instanced->Get("attributes").Keys()) {
      const tinygltf::Value& index = instanced->Get("attributes").Get(name);
      check.required(index.IsNumber() ? index.GetNumberAsInt() : -1, model.accessors.size(), name.c_str());
    }
  }
  for (size_t i = 0; i < model.scenes.size(); ++i) {
    check.set_place("scene", i);
    for (int node : model.scenes[i].nodes) check.required(node, model.nodes.size(), "node");
  }
  for (size_t i = 0; i < model.skins.size(); ++i) {
    const tinygltf::Skin& skin = model.skins[i];
    check.set_place("skin", i);
    check.optional(skin.inverseBindMatrices, model.accessors.size(), "inverseBindMatrices");
    check.optional(skin.skeleton, model.nodes.size(), "skeleton");
    for (int joint : skin.joints) check.required(joint, model.nodes.size(), "joint");
  }
}

}  // namespace

void check_indices(const Document& doc, size_t buffer_count) {
  const tinygltf::Model& model = doc.model;
  Checker check(doc);
  for (size_t i = 0; i < model.bufferViews.size(); ++i) {
    check.set_place("bufferView", i);
    check.required(model.bufferViews[i].buffer, buffer_count, "buffer");
  }
  for (size_t i = 0; i < doc.images.size(); ++i) {
    check.set_place("image", i);
    check.optional(doc.images[i].view, model.bufferViews.size(), "bufferView");
  }
  for (size_t i = 0; i < model.textures.size(); ++i) {
    check.set_place("texture", i);
    check.optional(model.textures[i].source, doc.images.size(), "source");
    check.optional(image_of_texture(doc, static_cast<int>(i)), doc.images.size(), "EXT_texture_webp.source");
    check.optional(model.textures[i].sampler, model.samplers.size(), "sampler");
  }
  check_accessors(model, check);
  check_meshes(model, check);
  check_nodes(model, check);
  check.set_place("scene", static_cast<size_t>(std::max(model.defaultScene, 0)));
  check.optional(model.defaultScene, model.scenes.size(), "the default scene");
}

}  // namespace lightgrid::gltf
