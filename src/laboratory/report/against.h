// A comparison held against an earlier one of the same views: what got slower or less exact.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace lightgrid::lab {

struct AgainstResult {
  std::vector<std::string> worse;  // one sentence each; empty: nothing is
  std::vector<std::string> told;   // figures that were not compared, and why; no failure
};

// Throws Error(input) that names the file, if it is not a results.json of `compare`.
nlohmann::json read_results_json(const std::filesystem::path& path);

// Both as results.json. Rows are the same if scene, size, number of lights, technique and settings agree.
// Worse is: an error that grew (grew, measures/error_measures.h) or is no longer finite; more pairs lost or
// wrong, or more pixels with NaN; a refusal of a row that ran; and a time, on the same devices. Times are
// relative to the reference if that is another row: worse if the 95 % interval lies above the earlier one.
// Otherwise (the reference itself, and files of earlier versions), a time is worse if the intervals of the
// median do not overlap. With n runs, the fastest and the slowest contain the median with the probability 1 -
// 2^(1-n); with fewer than five no time is compared. Where the reference is a row of both, its ratio must agree,
// so that a slower moment of the machine is no finding. Throws Error(input) that names `earlier_name` if nothing
// can be compared.
AgainstResult results_against(const nlohmann::json& now, const nlohmann::json& earlier,
                              const std::string& earlier_name);

}  // namespace lightgrid::lab
