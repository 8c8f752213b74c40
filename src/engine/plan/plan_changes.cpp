#include "plan/plan_changes.h"

#include <algorithm>

#include "plan/frame_plan.h"
#include "plan/settings/kernels.h"

namespace lightgrid {

std::vector<PlanChange> plan_changes(const std::vector<Decision>& before, const std::vector<Decision>& now,
                                     size_t frame) {
  std::vector<PlanChange> changes;
  for (const Decision& d : now) {
    const auto old = std::ranges::find(before, d.effect, &Decision::effect);
    if (old == before.end() || old->needed == d.needed) continue;
    changes.push_back({frame, d.effect, d.needed, d.needed ? "came: " + d.why : "left: " + old->why});
  }
  return changes;
}

void PathPlans::add(const FramePlan& plan) {
  const size_t frame = frames_++;
  if (plan.settings[setting::everything_on]) return;
  for (PlanChange& change : plan_changes(before_, plan.decisions, frame))
    changes_.push_back(std::move(change));
  before_ = plan.decisions;
}

}  // namespace lightgrid
