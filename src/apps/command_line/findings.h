// Findings as SARIF 2.1.0, which code hosts show beside a change.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lightgrid::app {

struct FindingRule {
  std::string id, description;
  std::string help_url;  // empty: none
};

struct Finding {
  std::string rule, message;
  std::string file;    // that it is about: a path
  std::string object;  // within the file, such as a light; empty: the file
};

// Each finding is an error. Rules without a finding say what was looked for.
nlohmann::ordered_json sarif_log(const std::string& tool, const std::vector<FindingRule>& rules,
                                 const std::vector<Finding>& findings);

}  // namespace lightgrid::app
