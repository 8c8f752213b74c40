// The plans of a path, frame by frame.
#pragma once

#include "plan/frame_plan.h"
#include "plan/plan_changes.h"

namespace lightgrid {

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
