// A parsed glTF file: its JSON as a tinygltf model, and the bytes of its buffers. Internal to load_gltf.
#pragma once

#include <tiny_gltf.h>
#include <array>
#include <map>
#include <span>

#include "scene/gltf/json.h"
#include "scene/gltf/resources.h"
#include "scene/load_gltf.h"

namespace lightgrid::gltf {

struct Document : Reporter {
  Document(const std::filesystem::path& path, const GltfLimits& bounds)
      : Reporter(path.string()), limits(bounds), reach(reach_of(path, bounds.files_anywhere)) {}

  GltfLimits limits;
  FileReach reach;
  tinygltf::Model model;  // without buffers, images and animations
  std::vector<ImageEntry> images;
  std::vector<AnimationEntry> animations;
  // The file's sets that are Mesh::uv0 and uv1, by material, where they are not 0 and 1; -1: none.
  std::map<int, std::array<int, 2>> uv_sets;
  std::map<std::pair<int, float>, int> roughness_textures;  // made of those with glossiness, by its factor
  Extras extras;
  std::vector<std::span<const uint8_t>> buffers;  // empty if the file gives no bytes
  std::vector<std::vector<uint8_t>> owned;        // memory that `buffers` points into
  std::map<int, std::vector<uint8_t>> decoded_views;
};

// Reads the file and its buffers, and parses the JSON with tinygltf. Unsupported required extensions are an
// error, others a warning. Indices in `model` are not checked yet: use `checked` for each.
Document read_document(const std::filesystem::path& path, const GltfLimits& limits);

// items[index], or an error "place: what is index, but there are size".
template <typename Items>
auto& checked(const Document& doc, Items& items, int index, const std::string& place, const char* what) {
  if (index < 0 || static_cast<size_t>(index) >= items.size())
    throw doc.error("{}: {} is {}, but there are {}", place, what, index, items.size());
  return items[static_cast<size_t>(index)];
}

// The extension's value, or nullptr.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name);

// A finite number of an extension; `absent` if missing.
double number_or(const Document& doc, const tinygltf::Value& object, const char* key, double absent,
                 const std::string& place);

// A non-negative integer of an extension; `absent` if missing.
size_t size_or(const Document& doc, const tinygltf::Value& object, const char* key, size_t absent,
               const std::string& place);

}  // namespace lightgrid::gltf
