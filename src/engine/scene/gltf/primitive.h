// One primitive of a mesh, and its morph targets.
#pragma once

#include <optional>

#include "scene/gltf/accessor.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

// Remaining capacity under GltfLimits::max_vertices; shared by all primitives.
struct Budget {
  explicit Budget(size_t max_vertices) : vertices(max_vertices), indices(max_vertices * 6) {}
  size_t vertices, indices;
};

// Subtracts `amount` from `left`, or throws an error "place: amount what more pass the limit".
void spend(const Document& doc, size_t& left, size_t amount, const std::string& place, const char* what);

struct Primitive {
  Mesh mesh;  // a triangle list; normals and tangents as in the file
  SkinWeights skin;
};

// Empty for points, lines and primitives without positions, with a warning for each kind. `mesh.material` is
// the file's index, or that of the last of `materials`. Errors: counts that differ between attributes, an
// index past the vertices, values that are not finite.
std::optional<Primitive> read_primitive(Document& doc, const tinygltf::Primitive& primitive,
                                        const std::vector<Material>& materials, Budget& budget,
                                        const std::string& place);

// Subtracts the vertices that flat normals would add from the budget.
void spend_on_flat_normals(const Document& doc, const Mesh& mesh, Budget& budget, const std::string& place);

// The node's weights, else its mesh's (glTF 2.0, 3.7.2.2); empty if all are 0 or there are none. Errors: a
// weight that is not finite.
std::vector<double> default_weights(const Document& doc, const tinygltf::Node& node,
                                    const tinygltf::Mesh& mesh, const std::string& place);

// The displacements of the attributes that `mesh` has, as read_primitive returns it: of all targets if the
// weights are animated, else of those with nonzero weight (others stay empty). No targets without weights, or
// for primitives without targets. Errors: a number of weights other than that of targets, a target whose
// count is not that of the vertices, values that are not finite, displaced vertices past the budget.
std::vector<MorphTarget> read_morph_targets(Document& doc, const tinygltf::Primitive& primitive,
                                            const std::vector<double>& weights, bool animated,
                                            const Mesh& mesh, Budget& budget, const std::string& place);

}  // namespace lightgrid::gltf
