#include "plan/path_plans.h"

namespace lightgrid {

void PathPlans::add(const FramePlan& plan) {
  const size_t frame = frames_++;
  if (plan.settings.everything_on) return;
  for (PlanChange& change : plan_changes(before_, plan.decisions, frame))
    changes_.push_back(std::move(change));
  before_ = plan.decisions;
}

}  // namespace lightgrid
