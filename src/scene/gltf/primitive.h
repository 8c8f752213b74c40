// One primitive of a mesh.
#pragma once

#include <optional>

#include "scene/gltf/accessor.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// What may still be read under GltfLimits::max_vertices; shared by all primitives.
struct Budget {
  explicit Budget(size_t max_vertices) : vertices(max_vertices), indices(max_vertices * 6) {}
  size_t vertices, indices;
};

// Takes `amount` from what is left, or an error "place: amount what more pass the limit".
void spend(const Document& doc, size_t& left, size_t amount, const std::string& place, const char* what);

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

// The tangents that a mesh of this material needs.
TangentNeed tangent_need(const Material& material);

// Takes from the budget the vertices that flat normals would add.
void spend_on_flat_normals(const Document& doc, const Mesh& mesh, Budget& budget, const std::string& place);

}  // namespace lightgrid::gltf
