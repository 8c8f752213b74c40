// Buffer views, plain and of EXT_meshopt_compression (Kapoulkine, glTF extension, 2021).
#include <meshoptimizer.h>

#include "scene/gltf/accessor.h"

namespace lightgrid::gltf {
namespace {

std::span<const uint8_t> plain_range(Document& doc, int buffer, size_t offset, size_t length,
                                     const std::string& place) {
  const auto& bytes = checked(doc, doc.buffers, buffer, place, "buffer");
  if (bytes.empty())
    throw doc.error("{}: buffer {} has no bytes: neither a uri nor a binary chunk", place, buffer);
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw doc.error("{}: {} bytes from byte {} on do not fit buffer {} of {}", place, length, offset, buffer,
                    bytes.size());
  return bytes.subspan(offset, length);
}

std::string string_or(const tinygltf::Value& object, const char* key, const char* absent) {
  return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : absent;
}

struct Packed {
  std::span<const uint8_t> bytes;
  size_t count = 0, stride = 0;
  std::string mode, filter;
};

Packed packed_view(Document& doc, const tinygltf::Value& extension, size_t byte_length,
                   const std::string& place) {
  Packed out{.count = size_or(doc, extension, "count", 0, place),
             .stride = size_or(doc, extension, "byteStride", 0, place),
             .mode = string_or(extension, "mode", ""),
             .filter = string_or(extension, "filter", "NONE")};
  const bool is_indices = out.mode == "TRIANGLES" || out.mode == "INDICES";
  if (!is_indices && out.mode != "ATTRIBUTES") throw doc.error("{}: mode is \"{}\"", place, out.mode);
  const bool stride_fits = is_indices ? out.stride == 2 || out.stride == 4
                                      : out.stride > 0 && out.stride % 4 == 0 && out.stride <= 256;
  if (!stride_fits) throw doc.error("{}: byteStride is {} for mode {}", place, out.stride, out.mode);
  if (out.count == 0 || out.count > byte_length / out.stride)
    throw doc.error("{}: count is {} of stride {}, but the view has {} bytes", place, out.count, out.stride,
                    byte_length);
  if (out.mode == "TRIANGLES" && out.count % 3 != 0)
    throw doc.error("{}: count is {}, not whole triangles", place, out.count);
  const bool filter_fits =
      out.filter == "NONE" ||
      (!is_indices && ((out.filter == "OCTAHEDRAL" && (out.stride == 4 || out.stride == 8)) ||
                       (out.filter == "QUATERNION" && out.stride == 8) || out.filter == "EXPONENTIAL"));
  if (!filter_fits) throw doc.error("{}: filter is \"{}\" for stride {}", place, out.filter, out.stride);
  const int buffer = static_cast<int>(size_or(doc, extension, "buffer", doc.buffers.size(), place));
  out.bytes = plain_range(doc, buffer, size_or(doc, extension, "byteOffset", 0, place),
                          size_or(doc, extension, "byteLength", 0, place), place);
  return out;
}

std::vector<uint8_t> unpack(Document& doc, const Packed& packed, const std::string& place) {
  // The densest encoding is two bits for sixteen bytes of one attribute, so a larger count must be wrong.
  const size_t decoded_bytes = packed.count * packed.stride;
  if (decoded_bytes / 64 > packed.bytes.size())
    throw doc.error("{}: count is {} of stride {}, too many for {} bytes", place, packed.count, packed.stride,
                    packed.bytes.size());
  std::vector<uint8_t> out(decoded_bytes);
  const uint8_t* from = packed.bytes.data();
  const size_t size = packed.bytes.size();
  int failed = 0;
  if (packed.mode == "ATTRIBUTES")
    failed = meshopt_decodeVertexBuffer(out.data(), packed.count, packed.stride, from, size);
  else if (packed.mode == "TRIANGLES")
    failed = meshopt_decodeIndexBuffer(out.data(), packed.count, packed.stride, from, size);
  else
    failed = meshopt_decodeIndexSequence(out.data(), packed.count, packed.stride, from, size);
  if (failed != 0) throw doc.error("{}: compressed data is broken (meshoptimizer {})", place, failed);
  if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), packed.count, packed.stride);
  if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), packed.count, packed.stride);
  if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), packed.count, packed.stride);
  return out;
}

}  // namespace

std::span<const uint8_t> view_bytes(Document& doc, int index, const std::string& place) {
  const auto& view = checked(doc, doc.model.bufferViews, index, place, "bufferView");
  const tinygltf::Value* extension = find_extension(view.extensions, "EXT_meshopt_compression");
  if (!extension) return plain_range(doc, view.buffer, view.byteOffset, view.byteLength, place);
  if (auto it = doc.decoded_views.find(index); it != doc.decoded_views.end()) return it->second;
  const std::string inner = fmt::format("{}: bufferView {}: EXT_meshopt_compression", place, index);
  const Packed packed = packed_view(doc, *extension, view.byteLength, inner);
  return doc.decoded_views[index] = unpack(doc, packed, inner);
}

}  // namespace lightgrid::gltf
