// The places on a camera path where the plans of a report's techniques change: each change is listed once,
// however many of them have it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "measures/results.h"
#include "plan/plan_changes.h"

namespace lightgrid::lab {

struct SharedPlanChange {
  PlanChange change;
  std::vector<size_t> rows;  // the report's rows, rising
};

// The changes of rows with RunResult::moving, by frame, and within a frame as the first row has them.
std::vector<SharedPlanChange> shared_plan_changes(const CompareReport& report);

// The value of `plan_changes` (docs/results_json.md).
nlohmann::json plan_changes_json(const std::vector<PlanChange>& changes);
nlohmann::json plan_changes_json(const CompareReport& report);

// "the plan changed at 2 of 12 frames along the path; effects that came or left: 5"; empty without a camera
// path.
std::string plan_changes_in_words(const CompareReport& report);

}  // namespace lightgrid::lab
