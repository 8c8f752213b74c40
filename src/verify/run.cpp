#include "verify/run.h"

#include <regex>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/timer.h"
#include "cl/error.h"
#include "verify/check.h"

namespace lightgrid::verify {
namespace {

const char* name_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "fail" : "skip";
}

std::string full_name(const HardCase& hard_case) {
  return fmt::format("{}/{}", hard_case.group, hard_case.name);
}

}  // namespace

std::vector<const HardCase*> chosen_cases(const std::string& filter) {
  std::vector<const HardCase*> chosen;
  try {
    const std::regex pattern(filter);
    for (const HardCase& hard_case : hard_cases())
      if (std::regex_search(full_name(hard_case), pattern)) chosen.push_back(&hard_case);
  } catch (const std::regex_error&) {
    throw input_error("filter: \"{}\" is not a regular expression", filter);
  }
  if (chosen.empty())
    throw input_error("filter: no case's name matches \"{}\"; names are like depth/all_sky", filter);
  return chosen;
}

Outcome outcome_of(const std::function<void(Check&)>& run, CullEngine& engine, uint64_t adversarial_lights) {
  Check check(engine, adversarial_lights);
  try {
    run(check);
  } catch (const Error& error) {
    check.fail(error.what());
  } catch (const cl::Error& error) {
    check.fail(cl_machine_error(error).what());
  }
  return check.outcome();
}

Outcome run_case(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights) {
  return outcome_of(hard_case.run, engine, adversarial_lights);
}

VerifyReport run_cases(const std::vector<std::unique_ptr<CullEngine>>& engines,
                       const VerifyOptions& options) {
  const std::vector<const HardCase*> chosen = chosen_cases(options.filter);
  VerifyReport report;
  const double all = double(engines.size() * chosen.size());
  for (const auto& engine : engines) {
    report.devices.push_back(engine->name());
    for (const HardCase* hard_case : chosen) {
      if (options.progress) options.progress(double(report.cases.size()) / all, full_name(*hard_case));
      const Timer timer;
      const Outcome outcome = run_case(*hard_case, *engine, options.adversarial_lights);
      report.cases.push_back({hard_case, engine->name(), outcome, timer.elapsed_ms()});
      report.failed += outcome.verdict == Verdict::fail;
    }
  }
  if (options.progress) options.progress(1, "done");
  return report;
}

nlohmann::ordered_json to_json(const VerifyReport& report) {
  nlohmann::ordered_json json = {
      {"devices", report.devices}, {"cases", nlohmann::ordered_json::array()}, {"failed", report.failed}};
  for (const CaseResult& result : report.cases) {
    const Outcome& o = result.outcome;
    nlohmann::ordered_json row = {{"group", result.hard_case->group},
                                  {"name", result.hard_case->name},
                                  {"device", result.device},
                                  {"trials", o.trials},
                                  {"contacts", o.contacts},
                                  {"lost", o.lost},
                                  {"excess_ratio", nullptr},
                                  {"result", name_of(o.verdict)},
                                  {"why", o.why}};
    if (o.excess_ratio) row["excess_ratio"] = *o.excess_ratio;
    json["cases"].push_back(row);
  }
  return json;
}

std::vector<std::string> catalogue_rows(const std::vector<const HardCase*>& cases) {
  std::vector<std::string> rows;
  for (const HardCase* c : cases)
    rows.push_back(fmt::format("| {} | `{}` | {} | {} | {} |", c - hard_cases().data() + 1, full_name(*c),
                               c->input, c->breaks, c->invariant));
  return rows;
}

}  // namespace lightgrid::verify
