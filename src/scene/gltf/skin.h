// Skins, at rest.
#pragma once

#include "scene/gltf/nodes.h"
#include "scene/gltf/primitive.h"

namespace lightgrid::gltf {

// The world matrix of each joint times its inverse bind matrix. Joints must be among `nodes`.
std::vector<glm::dmat4> joint_matrices(Document& doc, int skin, const std::vector<PlacedNode>& nodes);

// Moves positions, normals and tangents by the joints, into world space: a skinned mesh's own node has no say
// (glTF 2.0, 3.7.3.3). Weights are brought to sum 1.
void apply_skin(const Document& doc, const std::vector<glm::dmat4>& joints, const SkinWeights& weights,
                const std::string& place, Mesh& mesh);

}  // namespace lightgrid::gltf
