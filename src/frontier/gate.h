// A frontier held against an earlier one: what got worse.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lightgrid {

struct GateResult {
  std::vector<std::string> worse;  // one sentence each; empty: the gate is passed
  std::vector<std::string> told;   // what was not compared, and why; no failure
};

// frontier.json, as to_json(FrontierAnswer) gives it. Throws Error(input) that names the file.
nlohmann::json read_frontier_json(const std::filesystem::path& path);

// Points are the same if scene, label, averaged frames and size agree. Worse is: an error that is more
// than 1.001 times the earlier one and 1e-9 larger, or finite no more; more pairs lost or wrong, or more
// pixels with NaN, than earlier; a ratio whose 95 % interval lies above the earlier one's; a refusal of what
// ran earlier. A point of other views, or that is on one side only, is told. Throws Error(input) that names
// `earlier_name` and the field if `earlier` is malformed, is of another seed or baseline, or has no point to
// compare.
GateResult held_against(const nlohmann::json& now, const nlohmann::json& earlier,
                        const std::string& earlier_name);

}  // namespace lightgrid
