// One primitive of a mesh.
#pragma once

#include <optional>

#include "scene/gltf/accessor.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// What may still be read under GltfLimits::max_vertices; shared by all primitives.
struct Budget {
  explicit Budget(size_t max_vertices) : vertices(max_vertices), indices(max_vertices * 6) {}
  size_t vertices, indices;
};

struct SkinWeights {
  int sets = 0;                    // of four joints a vertex; 0: the primitive has none
  std::vector<glm::uvec4> joints;  // joints[vertex * sets + set]
  std::vector<glm::vec4> weights;
};

struct Primitive {
  Mesh mesh;  // a triangle list; normals and tangents as in the file
  SkinWeights skin;
};

// Nothing for points, lines and primitives without positions, each kind with a warning. `mesh.material` is
// the file's index, or that of the last of `materials`. Errors: counts that differ between attributes, an
// index past the vertices, values that are not finite.
std::optional<Primitive> read_primitive(Document& doc, const tinygltf::Primitive& primitive,
                                        const std::vector<Material>& materials, Budget& budget,
                                        const std::string& place);

// Makes normals and tangents where they are missing and needed, drops tangents nobody uses, sets bounds.
void complete_mesh(const Document& doc, const std::vector<Material>& materials, Budget& budget,
                   const std::string& place, Mesh& mesh);

}  // namespace lightgrid::gltf
