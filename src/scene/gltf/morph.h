// Morph targets at their default weights.
#pragma once

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

// The node's weights, else its mesh's (glTF 2.0, 3.7.2.2); empty where all are 0 or there are none. Errors: a
// weight that is not finite.
std::vector<double> default_weights(const Document& doc, const tinygltf::Node& node,
                                    const tinygltf::Mesh& mesh, const std::string& place);

// Adds each target's displacements times its weight to the attributes that `mesh` has: positions, normals,
// tangents (not their handedness), texture coordinates and colours. Normals and tangents come out as unit
// vectors, colours within 0 to 1. `mesh` is as read_primitive gives it, before its skin is applied. Weights
// have nothing to weight in a primitive without targets. Errors: a number of weights other than that of targets,
// a target whose count is not that of the vertices, a position that is moved to infinity.
void apply_morph_targets(Document& doc, const tinygltf::Primitive& primitive,
                         const std::vector<double>& weights, const std::string& place, Mesh& mesh);

}  // namespace lightgrid::gltf
