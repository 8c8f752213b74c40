#include "scene/gltf/document.h"

#include <algorithm>
#include <cmath>

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

// Indices out of range are errors everywhere, also in unused parts, but for those of animations, which their
// reader checks. The readers check that a buffer view fits its buffer, an accessor its view and an index
// value its vertices.
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

namespace fs = std::filesystem;

void parse_json(Document& doc, const PreparedJson& prepared) {
  tinygltf::TinyGLTF parser;
  std::string error, warning;
  bool parsed = false;
  try {
    parsed = parser.LoadASCIIFromString(&doc.model, &error, &warning, prepared.text.data(),
                                        static_cast<unsigned>(prepared.text.size()), "");
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  // tinygltf continues after some errors, such as an unreadable primitive.
  if (!parsed || !error.empty()) throw doc.error("{}", error.empty() ? "is not valid glTF" : error);
  doc.model.bufferViews.pop_back();
  for (tinygltf::Accessor& accessor : doc.model.accessors)
    if (accessor.bufferView == prepared.absent_view) accessor.bufferView = -1;
}

int major_version(const std::string& version) {
  return version.size() >= 3 && version[1] == '.' && std::isdigit(version[0]) ? version[0] - '0' : 0;
}

constexpr const char* basisu = "KHR_texture_basisu";

bool is_of_images(const std::string& extension) {
  return extension == basisu || extension == "EXT_texture_avif" || extension == "MSFT_texture_dds";
}

// Returns true if each texture also names an image of another format, which is used.
bool has_other_sources(const Document& doc) {
  for (size_t i = 0; i < doc.model.textures.size(); ++i)
    if (image_of_texture(doc, static_cast<int>(i)) < 0) return false;
  return true;
}

void check_asset(Document& doc) {
  const tinygltf::Asset& asset = doc.model.asset;
  if (major_version(asset.version) != 2)
    throw doc.error("asset.version is \"{}\"; only glTF 2 is read", asset.version);
  if (!asset.minVersion.empty() && asset.minVersion != "2.0")
    throw doc.error("asset.minVersion is \"{}\"; glTF 2.0 is read", asset.minVersion);
  for (const std::string& name : doc.model.extensionsRequired)
    if (!is_supported_extension(name) && !keeps_the_picture(name) &&
        !(is_of_images(name) && has_other_sources(doc)))
      throw doc.error(
          "requires the extension {}, which is not supported{}", name,
          name == basisu ? ": convert its KTX2 images to PNG (gltf-transform ktxdecompress IN OUT)" : "");
  for (const std::string& name : doc.model.extensionsUsed)
    if (!is_supported_extension(name)) doc.warn(name, "extension {} is not supported and left out", name);
}

void read_buffers(Document& doc, const std::vector<BufferEntry>& entries, const Container& container) {
  size_t bytes_left = doc.limits.max_file_bytes;
  for (size_t i = 0; i < entries.size(); ++i) {
    const BufferEntry& entry = entries[i];
    const std::string place = fmt::format("buffer {}: ", i);
    std::span<const uint8_t> bytes;
    if (!entry.uri.empty() && !entry.fallback) {
      doc.owned.push_back(read_uri(doc, place, doc.reach, entry.uri, bytes_left));
      bytes = doc.owned.back();
      bytes_left -= bytes.size();
    } else if (i == 0 && container.binary.data() && !entry.fallback) {
      bytes = container.binary;
    } else {
      doc.buffers.emplace_back();  // an error only if something reads from it
      continue;
    }
    if (bytes.size() < entry.byte_length)
      throw doc.error("{}byteLength is {}, but there are {} bytes", place, entry.byte_length, bytes.size());
    doc.buffers.push_back(bytes.first(entry.byte_length));
  }
}

}  // namespace

Document read_document(const fs::path& path, const GltfLimits& limits) {
  Document doc(path, limits);
  std::vector<uint8_t> file = read_regular_file(doc, "", path, limits.max_file_bytes);
  const Container container = open_container(doc, file);
  PreparedJson prepared = prepare_json(doc, container.json);
  parse_json(doc, prepared);
  check_asset(doc);
  doc.images = std::move(prepared.images);
  doc.animations = std::move(prepared.animations);
  doc.extras = std::move(prepared.extras);
  check_indices(doc, prepared.buffers.size());
  read_buffers(doc, prepared.buffers, container);
  if (container.is_glb) doc.owned.push_back(std::move(file));  // the first buffer points into it
  return doc;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto it = extensions.find(name);
  return it != extensions.end() && it->second.IsObject() ? &it->second : nullptr;
}

double number_or(const Document& doc, const tinygltf::Value& object, const char* key, double absent,
                 const std::string& place) {
  if (!object.Has(key)) return absent;
  const tinygltf::Value& value = object.Get(key);
  if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble()))
    throw doc.error("{}: {} is not a finite number", place, key);
  return value.GetNumberAsDouble();
}

size_t size_or(const Document& doc, const tinygltf::Value& object, const char* key, size_t absent,
               const std::string& place) {
  const double number = number_or(doc, object, key, static_cast<double>(absent), place);
  // Past 2^31 tinygltf's own integers have wrapped; no valid value here is as large.
  if (number < 0 || number > 2147483647 || std::trunc(number) != number)
    throw doc.error("{}: {} is {}: not a size that is read", place, key, number);
  return static_cast<size_t>(number);
}

}  // namespace lightgrid::gltf
