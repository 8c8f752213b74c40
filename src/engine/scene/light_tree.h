// A tree over many lights, of which any cell draws some without looking at the others
// (kernels/culling/sampled_tree.h).
#pragma once

#include <span>
#include <vector>

#include "scene/view_lights.h"

namespace lightgrid {

// Perfect and binary: node 1 is the root, 2 n and 2 n + 1 are the halves of node n, and the last half of all
// nodes are leaves, of one light or none.
struct LightTree {
  struct Node {
    glm::vec4 low{0};   // corner of the box of its lights, and the sum of their intensities' luminances
    glm::vec4 high{0};  // the other corner
  };
  std::vector<Node> nodes;       // the first is none
  std::vector<uint32_t> lights;  // lights of the leaves, by index
};

// Halves are of equal number, along the longest side of the box, so that lights of a node are neighbours.
// Lights that send nothing are in no leaf. Finite, whatever the lights' values.
LightTree light_tree(std::span<const ViewLight> lights);

}  // namespace lightgrid
