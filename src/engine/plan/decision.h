// One line of a plan: whether a frame needs this, and the reason.
#pragma once

#include <string>
#include <vector>

namespace lightgrid {

struct Decision {
  std::string effect;  // "blend", "spot lights", "normal maps", ...
  bool needed = false;
  std::string why;  // the witness: `material 3 "glass" on node 12 "window"`, or why not
};

using Decisions = std::vector<Decision>;

}  // namespace lightgrid
