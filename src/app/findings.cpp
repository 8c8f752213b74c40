#include "app/findings.h"

#include "base/version.h"

namespace lightgrid {

using nlohmann::ordered_json;

ordered_json sarif_log(const std::string& tool, const std::vector<FindingRule>& rules,
                       const std::vector<Finding>& findings) {
  ordered_json rule_list = ordered_json::array(), results = ordered_json::array();
  for (const FindingRule& rule : rules) {
    ordered_json entry = {{"id", rule.id}, {"shortDescription", {{"text", rule.description}}}};
    if (!rule.help_url.empty()) entry["helpUri"] = rule.help_url;
    rule_list.push_back(entry);
  }
  for (const Finding& finding : findings) {
    ordered_json location = {{"physicalLocation", {{"artifactLocation", {{"uri", finding.file}}}}}};
    if (!finding.object.empty())
      location["logicalLocations"] = ordered_json::array({{{"name", finding.object}, {"kind", "object"}}});
    results.push_back({{"ruleId", finding.rule},
                       {"level", "error"},
                       {"message", {{"text", finding.message}}},
                       {"locations", ordered_json::array({location})}});
  }
  const ordered_json driver = {{"name", tool}, {"version", version_of_build()}, {"rules", rule_list}};
  const ordered_json run = {{"tool", {{"driver", driver}}}, {"results", results}};
  return {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
          {"version", "2.1.0"},
          {"runs", ordered_json::array({run})}};
}

}  // namespace lightgrid
