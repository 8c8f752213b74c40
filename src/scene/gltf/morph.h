// Morph targets of a file.
#pragma once

#include "scene/gltf/primitive.h"

namespace lightgrid::gltf {

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
