#include "command_line/findings.h"

#include <fmt/format.h>

#include "base/version.h"

namespace lightgrid::app {

using nlohmann::ordered_json;

namespace {

// A path as a URI: RFC 3986 percent-encodes all but these characters.
std::string uri_of(const std::string& path) {
  const std::string kept = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string uri;
  for (const char c : path)
    uri += kept.find(c) != std::string::npos ? std::string(1, c) : fmt::format("%{:02X}", (unsigned char)c);
  return uri;
}

}  // namespace

ordered_json sarif_log(const std::string& tool, const std::vector<FindingRule>& rules,
                       const std::vector<Finding>& findings) {
  ordered_json rule_list = ordered_json::array(), results = ordered_json::array();
  for (const FindingRule& rule : rules) {
    ordered_json entry = {{"id", rule.id}, {"shortDescription", {{"text", rule.description}}}};
    if (!rule.help_url.empty()) entry["helpUri"] = rule.help_url;
    rule_list.push_back(entry);
  }
  for (const Finding& finding : findings) {
    ordered_json location = {{"physicalLocation", {{"artifactLocation", {{"uri", uri_of(finding.file)}}}}}};
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

}  // namespace lightgrid::app
