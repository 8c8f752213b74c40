// Morph targets of a file.
#pragma once

#include "scene/gltf/primitive.h"

namespace lightgrid::gltf {

// The node's weights, else its mesh's (glTF 2.0, 3.7.2.2); empty where all are 0 or there are none. Errors: a
// weight that is not finite.
std::vector<double> default_weights(const Document& doc, const tinygltf::Node& node,
                                    const tinygltf::Mesh& mesh, const std::string& place);

// The displacements of the attributes that `mesh` has, as read_primitive gives it: of all targets where the
// weights are animated, else of those whose weight is not 0 (others stay empty). No target where no weight is
// set: weights have nothing to weight in a primitive without targets. Errors: a number of weights other than
// that of targets, a target whose count is not that of the vertices, values that are not finite, displaced
// vertices past the budget.
std::vector<MorphTarget> read_morph_targets(Document& doc, const tinygltf::Primitive& primitive,
                                            const std::vector<double>& weights, bool animated,
                                            const Mesh& mesh, Budget& budget, const std::string& place);

}  // namespace lightgrid::gltf
