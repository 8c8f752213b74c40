// Elements of accessors in any layout: interleaved, sparse, normalised, compressed.
#pragma once

#include <glm/glm.hpp>

#include "scene/gltf/document.h"

namespace lightgrid::gltf {

// A buffer view's bytes, decoded if it is compressed by meshoptimizer (each view once).
std::span<const uint8_t> view_bytes(Document& doc, int view, const std::string& place);

struct FloatArray {
  int components = 0;
  std::vector<float> values;
  size_t count() const { return components ? values.size() / static_cast<size_t>(components) : 0; }
};

// always: for colours, normals, tangents and weights, whose integers have no other meaning.
enum class Normalize { as_accessor_says, always };

// Returns whether an accessor has no elements, which glTF forbids but exporters write for empty parts: one
// warning for all of them.
bool is_empty_accessor(Document& doc, int accessor, const std::string& place);

// All elements of an accessor of type SCALAR … VEC4 or MAT4; at most max_count, all finite.
FloatArray read_floats(Document& doc, int accessor, size_t max_count, Normalize normalize,
                       const std::string& place);

// An index accessor's elements: unsigned scalars.
std::vector<uint32_t> read_indices(Document& doc, int accessor, size_t max_count, const std::string& place);

// `fill` replaces components that the array lacks. The array must have min_components to N of them.
template <int N>
std::vector<glm::vec<N, float>> to_vectors(const Document& doc, const FloatArray& array, int min_components,
                                           float fill, const std::string& place) {
  if (array.components < min_components || array.components > N)
    throw doc.error("{}: has {} components instead of {}", place, array.components, N);
  std::vector<glm::vec<N, float>> out(array.count(), glm::vec<N, float>(fill));
  for (size_t i = 0; i < out.size(); ++i)
    for (int c = 0; c < array.components; ++c) out[i][c] = array.values[i * array.components + c];
  return out;
}

// KHR_draco_mesh_compression (Khronos, 2018): a primitive's indices and some of its attributes.
struct DracoGeometry {
  size_t vertex_count = 0;
  std::vector<uint32_t> indices;                 // triangle list
  std::map<std::string, FloatArray> attributes;  // by semantic: POSITION, …
};

// Decodes at most `max_vertices`, and three times as many indices.
DracoGeometry decode_draco(Document& doc, const tinygltf::Primitive& primitive,
                           const tinygltf::Value& extension, size_t max_vertices, const std::string& place);

}  // namespace lightgrid::gltf
