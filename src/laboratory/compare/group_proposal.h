// Light groups in place of shadows (scene/light_groups.h): what lights should leave out, by the light that
// goes through walls.
#pragma once

#include "oracle/leaks.h"

namespace lightgrid {

struct ProposedGroup {
  std::vector<int> lights;           // numbers in the scene
  std::vector<std::string> exclude;  // nodes on which these lights are seen nowhere, and leak
  uint64_t leaked = 0;               // pairs that it takes away
};

struct GroupProposal {
  std::vector<ProposedGroup> groups;  // most pairs first
  uint64_t leaked = 0,
           left = 0;  // of all pairs, and those that remain: where a node has both kinds of pixels
};

// Lights share a group where no node that one of them lights is left out by another. Those that have groups
// already, or leak nowhere, are in none. Nodes without a name cannot be left out. It takes no sampled pixel
// from a light that it sees; what no sample of the view saw, it does not know.
GroupProposal propose_groups(const Leaks& leaks, const Scene& scene);

// The scene with these groups. Throws Error(input) where it has too many of its own.
Scene with_groups(Scene scene, const GroupProposal& proposal);

// As `lightgrid plan --leaks` prints it; empty if there is none.
std::string describe(const GroupProposal& proposal, const Scene& scene);

}  // namespace lightgrid
