// The nodes of one scene, flattened.
#pragma once

#include "scene/gltf/document.h"
#include "scene/rig.h"

namespace lightgrid::gltf {

struct PlacedNode {
  int node = 0;     // index in the file
  int parent = -1;  // index in the flattened array; -1: a root
  NodeTransform transform;
  std::optional<glm::dmat4> matrix;  // replaces `transform`
  glm::dmat4 world_from_node{1};     // at rest
  bool moves = false;                // an animation moves this node or an ancestor; set by read_animations
  bool morphs = false;               // an animation sets its morph weights; set by read_animations
};

// Depth first, in the file's order. `scene` -1: the file's default, else its first scene, else (a file
// without scenes) all root nodes. Errors: an index out of range, a node reached twice (which covers cycles),
// deeper than limits.max_node_depth, a matrix that is not finite or not affine.
std::vector<PlacedNode> place_nodes(Document& doc, int scene);

// The same nodes as rig nodes.
std::vector<RigNode> rig_nodes(const Document& doc, const std::vector<PlacedNode>& nodes);

std::string node_label(const Document& doc, int node);

}  // namespace lightgrid::gltf
