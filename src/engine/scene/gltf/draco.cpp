#include "scene/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <draco/compression/decode.h>

namespace lightgrid::gltf {
namespace {

// Raw values, scaled by our own rule. Draco's ConvertValue would use the attribute's `normalized` flag, on
// which writers disagree and which its decoder reads from the file unchecked, as a bool of any bits.
template <typename T>
void read_values(const draco::PointAttribute& attribute, bool normalize, size_t point_count, float* to) {
  const int components = attribute.num_components();
  for (uint32_t point = 0; point < point_count; ++point) {
    const uint8_t* from = attribute.GetAddress(attribute.mapped_index(draco::PointIndex(point)));
    for (int c = 0; c < components; ++c, ++to) {
      T value;
      std::memcpy(&value, from + c * sizeof(T), sizeof(T));
      *to = static_cast<float>(value);
      if constexpr (std::is_integral_v<T>)
        if (normalize) *to = std::max(*to / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
    }
  }
}

size_t value_bytes(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
    case draco::DT_UINT8:
      return 1;
    case draco::DT_INT16:
    case draco::DT_UINT16:
      return 2;
    case draco::DT_UINT32:
    case draco::DT_FLOAT32:
      return 4;
    default:
      return 0;
  }
}

void check_layout(const Document& doc, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                  const std::string& place) {
  const size_t element_bytes = value_bytes(attribute.data_type()) * attribute.num_components();
  if (element_bytes == 0 || attribute.num_components() > 4)
    throw doc.error("{}: has {} components of Draco's type {}", place, int(attribute.num_components()),
                    int(attribute.data_type()));
  uint32_t last = 0;
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point)
    last = std::max(last, attribute.mapped_index(point).value());
  const auto stride = static_cast<size_t>(attribute.byte_stride()),
             offset = static_cast<size_t>(attribute.byte_offset());
  if (last >= attribute.size() || stride < element_bytes ||
      offset + last * stride + element_bytes > attribute.buffer()->data_size())
    throw doc.error("{}: its values do not fit its data", place);
}

FloatArray read_attribute(Document& doc, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                          const tinygltf::Accessor& accessor, const std::string& name,
                          const std::string& place) {
  check_layout(doc, mesh, attribute, place);
  FloatArray out{.components = attribute.num_components()};
  const size_t count = mesh.num_points();
  out.values.resize(count * out.components);
  float* to = out.values.data();
  const bool normalize = accessor.normalized || name.starts_with("COLOR_") || name.starts_with("WEIGHTS_") ||
                         name == "NORMAL" || name == "TANGENT";
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      read_values<int8_t>(attribute, normalize, count, to);
      break;
    case draco::DT_UINT8:
      read_values<uint8_t>(attribute, normalize, count, to);
      break;
    case draco::DT_INT16:
      read_values<int16_t>(attribute, normalize, count, to);
      break;
    case draco::DT_UINT16:
      read_values<uint16_t>(attribute, normalize, count, to);
      break;
    case draco::DT_UINT32:
      read_values<uint32_t>(attribute, normalize, count, to);
      break;
    default:
      read_values<float>(attribute, normalize, count, to);
  }
  for (size_t i = 0; i < out.values.size(); ++i)
    if (!std::isfinite(out.values[i]))
      throw doc.error("{}: element {} is {}", place, i / out.components, out.values[i]);
  return out;
}

}  // namespace

DracoGeometry decode_draco(Document& doc, const tinygltf::Primitive& primitive,
                           const tinygltf::Value& extension, size_t max_vertices,
                           const std::string& outer_place) {
  const std::string place = outer_place + ": KHR_draco_mesh_compression";
  const auto bytes = view_bytes(
      doc, static_cast<int>(size_or(doc, extension, "bufferView", doc.model.bufferViews.size(), place)),
      place);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw doc.error("{}: {}", place, decoded.status().error_msg());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  if (!mesh || mesh->num_points() == 0) throw doc.error("{}: has no vertices", place);
  if (mesh->num_points() > max_vertices || mesh->num_faces() > max_vertices)
    throw doc.error("{}: has {} vertices and {} triangles; at most {} are read", place, mesh->num_points(),
                    mesh->num_faces(), max_vertices);

  DracoGeometry out{.vertex_count = mesh->num_points()};
  out.indices.reserve(size_t(mesh->num_faces()) * 3);
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
    for (const draco::PointIndex& corner : mesh->face(face)) out.indices.push_back(corner.value());
  if (!extension.Get("attributes").IsObject()) throw doc.error("{}: attributes is not an object", place);
  for (const auto& [name, id] : extension.Get("attributes").Get<tinygltf::Value::Object>()) {
    const auto accessor = primitive.attributes.find(name);
    if (accessor == primitive.attributes.end())
      throw doc.error("{}: {} is not an attribute of the primitive", place, name);
    if (!id.IsInt()) throw doc.error("{}: {} is not an index", place, name);
    const draco::PointAttribute* attribute =
        mesh->GetAttributeByUniqueId(static_cast<uint32_t>(id.Get<int>()));
    if (!attribute) throw doc.error("{}: has no attribute {} for {}", place, id.Get<int>(), name);
    out.attributes[name] = read_attribute(
        doc, *mesh, *attribute, checked(doc, doc.model.accessors, accessor->second, place, "accessor"), name,
        place + ": " + name);
  }
  return out;
}

}  // namespace lightgrid::gltf
