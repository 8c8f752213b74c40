#include "measures/path_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace lightgrid::lab {
namespace {

nlohmann::json change_json(const PlanChange& change) {
  const auto state = [](bool needed) { return needed ? "on" : "off"; };
  return {{"frame", change.frame},
          {"effect", change.effect},
          {"from", state(!change.needed)},
          {"to", state(change.needed)},
          {"why", change.why}};
}

size_t moving_rows(const CompareReport& report) {
  return size_t(std::ranges::count_if(report.rows, [](const RunResult& row) { return bool(row.moving); }));
}

}  // namespace

std::vector<SharedPlanChange> shared_plan_changes(const CompareReport& report) {
  std::vector<SharedPlanChange> shared;
  for (size_t row = 0; row < report.rows.size(); ++row) {
    if (!report.rows[row].moving) continue;
    for (const PlanChange& change : report.rows[row].moving->plan_changes) {
      // Sorted by frame at all times: a new change goes behind those of its frame.
      const auto frame_of = [](const SharedPlanChange& s) { return s.change.frame; };
      const auto first = std::ranges::lower_bound(shared, change.frame, {}, frame_of);
      const auto last = std::ranges::upper_bound(shared, change.frame, {}, frame_of);
      const auto same = std::ranges::find(first, last, change, &SharedPlanChange::change);
      if (same == last) {
        shared.insert(last, {change, {row}});
      } else {
        same->rows.push_back(row);
      }
    }
  }
  return shared;
}

nlohmann::json plan_changes_json(const std::vector<PlanChange>& changes) {
  nlohmann::json list = nlohmann::json::array();
  for (const PlanChange& change : changes) list.push_back(change_json(change));
  return list;
}

nlohmann::json plan_changes_json(const CompareReport& report) {
  nlohmann::json list = nlohmann::json::array();
  for (const SharedPlanChange& shared : shared_plan_changes(report)) {
    list.push_back(change_json(shared.change));
    if (shared.rows.size() < moving_rows(report)) list.back()["rows"] = shared.rows;
  }
  return list;
}

std::string plan_changes_in_words(const CompareReport& report) {
  const auto row = std::ranges::find_if(report.rows, [](const RunResult& r) { return bool(r.moving); });
  if (row == report.rows.end()) return "";
  const std::vector<SharedPlanChange> changes = shared_plan_changes(report);
  std::set<size_t> frames;
  for (const SharedPlanChange& shared : changes) frames.insert(shared.change.frame);
  if (frames.empty()) return "the plan never changed along the path";
  return fmt::format("the plan changed at {} of {} frames along the path; effects that came or left: {}",
                     frames.size(), row->moving->frames, changes.size());
}

}  // namespace lightgrid::lab
