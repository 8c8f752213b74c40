#include "scene/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <meshoptimizer.h>

namespace lightgrid::gltf {
namespace {

// Buffer views, plain and of EXT_meshopt_compression (Kapoulkine, glTF extension, 2021), under whose name
// prepare_json puts KHR_meshopt_compression too: streams of version 0 are the same.
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
  // The upper half of a stream's first byte is its kind, the lower half its version.
  if (failed != 0 && packed.mode == "ATTRIBUTES" && size > 0 && (*from >> 4) == 0xa && (*from & 0xf) > 0)
    throw doc.error(
        "{}: the stream has version {}, but the installed meshoptimizer library {}.{} reads "
        "version 0: write the file with EXT_meshopt_compression or uncompressed",
        place, *from & 0xf, MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100);
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
  const std::string inner = fmt::format("{}: bufferView {}: meshopt compression", place, index);
  const Packed packed = packed_view(doc, *extension, view.byteLength, inner);
  return doc.decoded_views[index] = unpack(doc, packed, inner);
}

namespace {

struct Layout {
  const uint8_t* first = nullptr;  // null: all zero
  size_t stride = 0, count = 0;
  int component_type = 0, components = 0;
};

int component_bytes(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

// `offset` and `count` come from the file: written so that no sum or product can overflow.
const uint8_t* checked_range(Document& doc, std::span<const uint8_t> bytes, size_t offset, size_t stride,
                             size_t count, size_t element_bytes, const std::string& place) {
  if (offset > bytes.size() || bytes.size() - offset < element_bytes ||
      (count - 1) > (bytes.size() - offset - element_bytes) / stride)
    throw doc.error("{}: {} elements of {} bytes, {} apart, from byte {} on do not fit a view of {} bytes",
                    place, count, element_bytes, stride, offset, bytes.size());
  return bytes.data() + offset;
}

Layout layout_of(Document& doc, const tinygltf::Accessor& accessor, size_t max_count,
                 const std::string& place) {
  Layout out{.count = accessor.count, .component_type = accessor.componentType};
  const int bytes = component_bytes(accessor.componentType);
  if (bytes == 0) throw doc.error("{}: componentType is {}", place, accessor.componentType);
  out.components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  const bool is_matrix = out.components > 4 || accessor.type == TINYGLTF_TYPE_MAT2;
  // Matrices of small integers have padded columns; nothing read here uses them.
  if (is_matrix && (accessor.type != TINYGLTF_TYPE_MAT4 || bytes != 4))
    throw doc.error("{}: a matrix of this type is not read here", place);
  if (out.count == 0) throw doc.error("{}: count is 0", place);
  if (out.count > max_count) throw doc.error("{}: count is {}, more than {}", place, out.count, max_count);
  const size_t element_bytes = static_cast<size_t>(bytes) * out.components;
  out.stride = element_bytes;
  if (accessor.bufferView < 0) return out;
  const auto& view = checked(doc, doc.model.bufferViews, accessor.bufferView, place, "bufferView");
  if (view.byteStride != 0) out.stride = view.byteStride;
  if (out.stride < element_bytes)
    throw doc.error("{}: byteStride is {}, but an element has {} bytes", place, out.stride, element_bytes);
  if ((accessor.byteOffset | view.byteOffset | out.stride) % bytes != 0)
    doc.warn("alignment", "{}: not aligned to its component type; read all the same", place);
  out.first = checked_range(doc, view_bytes(doc, accessor.bufferView, place), accessor.byteOffset, out.stride,
                            out.count, element_bytes, place);
  return out;
}

template <typename From, typename To>
void convert_typed(const Layout& layout, bool normalize, To* to) {
  const auto largest = static_cast<float>(std::numeric_limits<From>::max());
  for (size_t i = 0; i < layout.count; ++i) {
    for (int c = 0; c < layout.components; ++c) {
      From value;
      std::memcpy(&value, layout.first + i * layout.stride + c * sizeof(From), sizeof(From));
      To& out = to[i * layout.components + c];
      out = static_cast<To>(value);
      // glTF 2.0, 3.6.2.2: max(c / 127, -1) for signed integers.
      if constexpr (std::is_same_v<To, float> && std::is_integral_v<From>)
        if (normalize) out = std::max(static_cast<float>(value) / largest, -1.0f);
    }
  }
}

template <typename To>
void convert(const Layout& layout, bool normalize, To* to) {
  if (!layout.first) return;
  switch (layout.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert_typed<int8_t>(layout, normalize, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert_typed<uint8_t>(layout, normalize, to);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert_typed<int16_t>(layout, normalize, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert_typed<uint16_t>(layout, normalize, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert_typed<uint32_t>(layout, normalize, to);
    default:
      if constexpr (std::is_same_v<To, float>) return convert_typed<float>(layout, normalize, to);
  }
}

// Sparse values are packed in a view of their own, and replace the elements at their indices.
template <typename To>
void apply_sparse(Document& doc, const tinygltf::Accessor& accessor, const Layout& base, bool normalize,
                  std::vector<To>& values, const std::string& place) {
  const auto& sparse = accessor.sparse;
  if (sparse.count == 0) return doc.warn("sparse 0", "{}: sparse.count is 0; nothing is replaced", place);
  if (sparse.count < 1 || static_cast<size_t>(sparse.count) > base.count)
    throw doc.error("{}: sparse.count is {}", place,
                    sparse.count < 1 ? "not a number from 1 to the accessor's count"
                                     : fmt::format("{} of {}", sparse.count, base.count));
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    throw doc.error("{}: sparse byteOffset is negative", place);
  const auto count = static_cast<size_t>(sparse.count);

  Layout indices{.count = count, .component_type = sparse.indices.componentType, .components = 1};
  indices.stride = component_bytes(sparse.indices.componentType);
  if (sparse.indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      sparse.indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      sparse.indices.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    throw doc.error("{}: sparse.indices.componentType is {}", place, sparse.indices.componentType);
  indices.first = checked_range(doc, view_bytes(doc, sparse.indices.bufferView, place),
                                sparse.indices.byteOffset, indices.stride, count, indices.stride, place);
  std::vector<uint32_t> where(count);
  convert(indices, false, where.data());

  Layout packed = base;
  packed.count = count;
  packed.stride = static_cast<size_t>(component_bytes(base.component_type)) * base.components;
  packed.first = checked_range(doc, view_bytes(doc, sparse.values.bufferView, place),
                               sparse.values.byteOffset, packed.stride, count, packed.stride, place);
  std::vector<To> replacements(count * base.components);
  convert(packed, normalize, replacements.data());
  for (size_t i = 0; i < count; ++i) {
    if (where[i] >= base.count) throw doc.error("{}: sparse index {} of {}", place, where[i], base.count);
    if (i > 0 && where[i] <= where[i - 1]) throw doc.error("{}: sparse indices do not increase", place);
    for (int c = 0; c < base.components; ++c)
      values[size_t(where[i]) * base.components + c] = replacements[i * base.components + c];
  }
}

template <typename To>
std::vector<To> read_all(Document& doc, const tinygltf::Accessor& accessor, const Layout& layout,
                         bool normalize, const std::string& place) {
  std::vector<To> values(layout.count * layout.components);
  convert(layout, normalize, values.data());
  if (accessor.sparse.isSparse) apply_sparse(doc, accessor, layout, normalize, values, place);
  return values;
}

}  // namespace

bool is_empty_accessor(Document& doc, int accessor, const std::string& place) {
  if (checked(doc, doc.model.accessors, accessor, place, "accessor").count != 0) return false;
  doc.warn("count 0", "{}: accessor {}: count is 0; left out", place, accessor);
  return true;
}

FloatArray read_floats(Document& doc, int index, size_t max_count, Normalize normalize,
                       const std::string& place) {
  const auto& accessor = checked(doc, doc.model.accessors, index, place, "accessor");
  const Layout layout = layout_of(doc, accessor, max_count, place);
  FloatArray out{.components = layout.components};
  const bool normalized = accessor.normalized || normalize == Normalize::always;
  out.values = read_all<float>(doc, accessor, layout, normalized, place);
  for (size_t i = 0; i < out.values.size(); ++i)
    if (!std::isfinite(out.values[i]))
      throw doc.error("{}: element {} is {}", place, i / layout.components, out.values[i]);
  return out;
}

std::vector<uint32_t> read_indices(Document& doc, int index, size_t max_count, const std::string& place) {
  const auto& accessor = checked(doc, doc.model.accessors, index, place, "accessor");
  const Layout layout = layout_of(doc, accessor, max_count, place);
  if (layout.components != 1) throw doc.error("{}: indices are not of type SCALAR", place);
  if (layout.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      layout.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      layout.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    throw doc.error("{}: indices have componentType {}", place, layout.component_type);
  return read_all<uint32_t>(doc, accessor, layout, false, place);
}

}  // namespace lightgrid::gltf
