#include "scene/gltf/draco.h"

#include <cmath>

#include <draco/compression/decode.h>

namespace lightgrid::gltf {
namespace {

float largest_integer(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 65535;
    default:
      return 1;
  }
}

// The accessor says what the numbers mean; Draco's own flag is set by some writers and not by others.
FloatArray read_attribute(Document& doc, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                          const tinygltf::Accessor& accessor, const std::string& name,
                          const std::string& place) {
  FloatArray out{.components = attribute.num_components()};
  if (out.components < 1 || out.components > 4)
    throw doc.error("{}: has {} components", place, out.components);
  const bool always =
      name.starts_with("COLOR_") || name.starts_with("WEIGHTS_") || name == "NORMAL" || name == "TANGENT";
  const bool scale = (accessor.normalized || always) && !attribute.normalized();
  const float largest = scale ? largest_integer(accessor.componentType) : 1;
  out.values.resize(size_t(mesh.num_points()) * out.components);
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(point);
    float* to = &out.values[size_t(point.value()) * out.components];
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<float>(value, attribute.num_components(), to))
      throw doc.error("{}: element {} cannot be read", place, point.value());
    for (int c = 0; c < out.components; ++c) {
      if (!std::isfinite(to[c])) throw doc.error("{}: element {} is {}", place, point.value(), to[c]);
      to[c] = scale ? std::max(to[c] / largest, -1.0f) : to[c];
    }
  }
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
  if (!mesh || mesh->num_points() == 0) throw doc.error("{}: holds no vertices", place);
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
