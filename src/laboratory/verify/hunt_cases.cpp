#include "verify/hunt_cases.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/timer.h"
#include "verify/chosen_by_name.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

std::vector<RandomCase> chosen_random_cases(const std::string& filter) {
  std::vector<RandomCase> all = random_sample_cases();
  const std::vector<RandomCase> of_indices = random_light_index_cases();
  all.insert(all.end(), of_indices.begin(), of_indices.end());
  return chosen_by_name(
      all, filter, [](const RandomCase& c) { return c.name; }, "class of the hunt of cases",
      "coverage or packings");
}

void hunt_in(const RandomCase& hunted, CullEngine& engine, uint64_t seed, CaseHuntTally& tally) {
  const Timer timer;
  const Outcome outcome = outcome_of(
      [&](Check& c) {
        Random random(Random::mix(seed));
        c.trials(1);  // a view of nothing is no fault
        hunted.run(c, random);
      },
      engine, 0);
  ++tally.cases;
  tally.trials += outcome.trials;
  tally.contacts += outcome.contacts;
  tally.lost += outcome.lost;
  tally.skipped += outcome.verdict == Verdict::skip;
  if (outcome.verdict == Verdict::fail) tally.failed.push_back(seed);
  if (tally.why.empty() && !outcome.why.empty()) tally.why = fmt::format("seed {}: {}", seed, outcome.why);
  tally.seconds += timer.elapsed_ms() / 1000;
}

nlohmann::ordered_json json_of(const CaseHuntTally& t) {
  return {{"name", t.name},         {"cases", t.cases},         {"trials", t.trials},
          {"contacts", t.contacts}, {"lost", t.lost},           {"skipped", t.skipped},
          {"seconds", t.seconds},   {"failed_seeds", t.failed}, {"why", t.why}};
}

}  // namespace

CaseHuntTally CaseHuntReport::total() const {
  CaseHuntTally sum{.name = "all"};
  for (const CaseHuntTally& t : classes) {
    sum.cases += t.cases;
    sum.trials += t.trials;
    sum.contacts += t.contacts;
    sum.lost += t.lost;
    sum.skipped += t.skipped;
    sum.seconds += t.seconds;
    sum.failed.insert(sum.failed.end(), t.failed.begin(), t.failed.end());
  }
  return sum;
}

bool CaseHuntReport::failed() const { return !total().failed.empty(); }

CaseHuntReport hunt_cases(CullEngine& engine, const HuntOptions& options) {
  const std::vector<RandomCase> classes = chosen_random_cases(options.filter);
  CaseHuntReport report{.device = engine.name(), .seed = options.seed, .seconds = 0, .classes = {}};
  for (const RandomCase& hunted : classes) report.classes.push_back({.name = hunted.name});
  const Timer timer;
  const auto done = [&] {
    if (options.contacts) return double(report.total().contacts) / double(options.contacts);
    return timer.elapsed_ms() / 60'000 / options.minutes;
  };
  const auto can_none = [&] {
    return std::ranges::all_of(report.classes, [](const CaseHuntTally& t) { return t.skipped > 0; });
  };
  for (uint64_t i = 0; done() < 1 && !can_none(); ++i) {
    const size_t at = i % classes.size();
    if (options.progress) options.progress(std::min(done(), 0.999), classes[at].name);
    hunt_in(classes[at], engine, options.seed + i, report.classes[at]);
  }
  if (options.progress) options.progress(1, "done");
  report.seconds = timer.elapsed_ms() / 1000;
  return report;
}

nlohmann::ordered_json to_json(const CaseHuntReport& report) {
  nlohmann::ordered_json json = {
      {"device", report.device}, {"seed", report.seed}, {"seconds", report.seconds}};
  nlohmann::ordered_json all = json_of(report.total());
  for (const char* key : {"name", "seconds", "why"}) all.erase(key);
  json.update(all);
  json["classes"] = nlohmann::ordered_json::array();
  for (const CaseHuntTally& tally : report.classes) json["classes"].push_back(json_of(tally));
  return json;
}

}  // namespace lightgrid::lab::verify
