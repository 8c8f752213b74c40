// The tree with 16 children to a node, for packets of 16 segments on CPUs (kernels/rays/wide_walk.h).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "shared/ray_records.h"

namespace lightgrid {

struct WideTree {
  std::vector<RayWideNode> nodes;  // the root first
  // Where the two boxes of each node of the binary tree stand: RAY_WIDTH * node + child; -1: nowhere, the
  // child was opened or does not exist.
  std::vector<std::array<int, 2>> slots;
};

// Opens children of a node until there are 16: the largest by surface area (Wald, Benthin, Boulos, "Getting
// Rid of Packets", RT 2008), and where none has more than 16 leaves, those with the fewest.
WideTree wide_tree(std::span<const RayNode> nodes);

}  // namespace lightgrid
