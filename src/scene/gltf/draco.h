// KHR_draco_mesh_compression (Khronos, 2018): a primitive's indices and some of its attributes.
#pragma once

#include "scene/gltf/accessor.h"

namespace lightgrid::gltf {

struct DracoGeometry {
  size_t vertex_count = 0;
  std::vector<uint32_t> indices;                 // triangle list
  std::map<std::string, FloatArray> attributes;  // by semantic: POSITION, …
};

// Decodes at most `max_vertices`, and three times as many indices.
DracoGeometry decode_draco(Document& doc, const tinygltf::Primitive& primitive,
                           const tinygltf::Value& extension, size_t max_vertices, const std::string& place);

}  // namespace lightgrid::gltf
