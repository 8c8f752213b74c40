// Runs the catalogue of hard cases on this machine's devices: `lightgrid verify`.
#pragma once

#include <functional>

#include <nlohmann/json_fwd.hpp>

#include "verify/engine.h"
#include "verify/hard_case.h"

namespace lightgrid::verify {

struct CaseResult {
  const HardCase* hard_case = nullptr;
  std::string device;
  Outcome outcome;
  double wall_ms = 0;
};

struct VerifyReport {
  std::vector<std::string> devices;
  std::vector<CaseResult> cases;
  int failed = 0;
};

struct VerifyOptions {
  std::string filter;  // a regular expression searched in "group/name"; empty: all
  uint64_t adversarial_lights = 100'000;
  std::function<void(double done, const std::string& step)> progress;
};

// Throws Error(input) if the filter is no regular expression or matches no case.
std::vector<const HardCase*> chosen_cases(const std::string& filter);

Outcome run_case(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights);

VerifyReport run_cases(const std::vector<std::unique_ptr<CullEngine>>& engines, const VerifyOptions& options);

// The outcome of `run` on the engine. An exception of the engine fails the case.
Outcome outcome_of(const std::function<void(Check&)>& run, CullEngine& engine, uint64_t adversarial_lights);

nlohmann::ordered_json to_json(const VerifyReport& report);

// The catalogue as the table of docs/hard_cases.md: a row a case.
std::vector<std::string> catalogue_rows(const std::vector<const HardCase*>& cases);

}  // namespace lightgrid::verify
