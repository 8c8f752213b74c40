#include "scene/gltf/document.h"

#include <cmath>

#include "scene/gltf/container.h"
#include "scene/gltf/validate.h"

namespace lightgrid::gltf {
namespace {

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

void check_asset(Document& doc) {
  const tinygltf::Asset& asset = doc.model.asset;
  if (major_version(asset.version) != 2)
    throw doc.error("asset.version is \"{}\"; only glTF 2 is read", asset.version);
  if (!asset.minVersion.empty() && asset.minVersion != "2.0")
    throw doc.error("asset.minVersion is \"{}\"; glTF 2.0 is read", asset.minVersion);
  for (const std::string& name : doc.model.extensionsRequired)
    if (!is_supported_extension(name))
      throw doc.error("requires the extension {}, which is not supported", name);
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
      doc.owned.push_back(read_uri(doc, place, doc.folder, entry.uri, bytes_left));
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
  Document doc(path);
  doc.limits = limits;
  std::vector<uint8_t> file = read_regular_file(doc, "", path, limits.max_file_bytes);
  const Container container = open_container(doc, file);
  PreparedJson prepared = prepare_json(doc, container.json);
  parse_json(doc, prepared);
  check_asset(doc);
  doc.images = std::move(prepared.images);
  doc.animations = std::move(prepared.animations);
  doc.models = std::move(prepared.models);
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
