// The nodes of one scene, flattened.
#pragma once

#include <glm/glm.hpp>

#include "scene/gltf/document.h"

namespace lightgrid::gltf {

struct PlacedNode {
  int node = 0;
  glm::dmat4 world_from_node{1};
};

// Depth first, in the file's order. `scene` -1: the file's default, else its first scene, else (a file
// without scenes) all nodes that are no other's child. Errors: an index out of range, a node reached twice
// (which covers cycles), deeper than limits.max_node_depth, a matrix that is not finite or not affine.
std::vector<PlacedNode> place_nodes(Document& doc, int scene);

std::string node_label(const Document& doc, int node);

}  // namespace lightgrid::gltf
