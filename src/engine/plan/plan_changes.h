// Where the plan changes while a camera moves, and why.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plan/frame_plan.h"

namespace lightgrid {

struct PlanChange {
  size_t frame = 0;     // number in the path, from 0: the first with the new plan
  std::string effect;   // as in Decision
  bool needed = false;  // from this frame on
  std::string why;  // "came: " and the new plan's witness, or "left: " and the witness of the plan before it

  bool operator==(const PlanChange&) const = default;
};

// The effects that one plan needs and the other does not, in the order of `now`. Both are plans of one
// technique with the same settings. Another witness of the same effect is no change.
std::vector<PlanChange> plan_changes(const std::vector<Decision>& before, const std::vector<Decision>& now,
                                     size_t frame);

// The plans of a path, frame by frame.
class PathPlans {
 public:
  // The next frame's plan. The first has nothing to differ from, and with the setting everything-on no plan
  // differs from another.
  void add(const FramePlan& plan);

  const std::vector<PlanChange>& changes() const { return changes_; }

 private:
  std::vector<Decision> before_;
  std::vector<PlanChange> changes_;
  size_t frames_ = 0;
};

}  // namespace lightgrid
