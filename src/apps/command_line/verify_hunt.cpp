#include "command_line/verify_hunt.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "verify/hunt_cases.h"
#include "verify/hunt_shadows.h"

namespace lightgrid::app {
using namespace lab;
namespace {

constexpr double max_minutes = 100'000;
constexpr uint64_t short_hunt = 1'000'000;  // contacts: a shorter hunt would take less time than building the
                                            // kernels of all settings

double parse_minutes(const std::string& text) {
  const auto minutes = parse_number<double>(text);
  if (!minutes || !(*minutes > 0 && *minutes <= max_minutes))
    throw input_error("--hunt {}: not a number of minutes above 0 and up to {}", text, max_minutes);
  return *minutes;
}

void print(const verify::HuntReport& report) {
  const auto row = [](const verify::HuntTally& t) {
    fmt::print("  {:<13} {:>12} {:>8} {:>7} {:>7} {:>7} {:>8.0f} {:>8.0f}  {}\n", t.name, t.contacts, t.lost,
               t.views, t.refused, t.shapes_differ, t.contacts ? t.seconds * 1e9 / double(t.contacts) : 0,
               t.cpu_ns_each, t.why);
    if (!t.refusal.empty()) fmt::print("  {:<13} refused: {}\n", t.name, t.refusal);
  };
  fmt::print("{}, seed {}\n", report.device, report.seed);
  fmt::print("  {:<13} {:>12} {:>8} {:>7} {:>7} {:>7} {:>8} {:>8}\n", "class", "contacts", "lost", "views",
             "refused", "differ", "ns each", "cpu ns");
  for (const verify::HuntTally& tally : report.classes) row(tally);
  row(report.total());
  for (const std::string& folder : report.saved) fmt::print("saved {}\n", folder);
}

void print(const verify::ShadowHuntReport& report) {
  const auto row = [](const verify::ShadowHuntTally& t) {
    const verify::ShadowPairs& p = t.pairs;
    fmt::print("  {:<13} {:>12} {:>12} {:>10} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9.2f}  {}\n",
               t.name, p.decided(), p.hidden, p.either, p.leaked, p.acned, t.views, t.refused,
               t.shapes_differ, t.frames, t.stale, t.seconds > 0 ? double(p.decided()) / t.seconds / 1e6 : 0,
               p.why.empty() ? t.refusal : p.why);
  };
  fmt::print("{}, seed {}\n", report.device, report.seed);
  fmt::print("  {:<13} {:>12} {:>12} {:>10} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9}\n", "class",
             "pairs", "hidden", "either", "leaked", "acned", "views", "refused", "differ", "frames", "stale",
             "M pairs/s");
  for (const verify::ShadowHuntTally& tally : report.classes) row(tally);
  row(report.total());
  for (const verify::ShadowHuntTally& tally : report.classes) {
    for (const uint64_t seed : tally.failed) fmt::print("failed: {} {}\n", tally.name, seed);
  }
}

void print(const verify::CaseHuntReport& report) {
  const auto row = [](const verify::CaseHuntTally& t) {
    fmt::print("  {:<13} {:>8} {:>12} {:>12} {:>8} {:>7} {:>7}  {}\n", t.name, t.cases, t.trials, t.contacts,
               t.lost, t.failed.size(), t.skipped, t.why);
  };
  fmt::print("{}, seed {}\n", report.device, report.seed);
  fmt::print("  {:<13} {:>8} {:>12} {:>12} {:>8} {:>7} {:>7}\n", "class", "cases", "trials", "contacts",
             "lost", "failed", "skipped");
  for (const verify::CaseHuntTally& tally : report.classes) row(tally);
  row(report.total());
  for (const verify::CaseHuntTally& tally : report.classes) {
    for (const uint64_t seed : tally.failed)
      fmt::print("failed: --hunt 1 --cases --contacts 1 --seed {} --filter '^{}$'\n", seed, tally.name);
  }
}

template <typename Report>
int tell(const Report& report, const std::string& json) {
  if (!json.empty()) write_json(json, verify::to_json(report).dump(1) + "\n");
  if (json != "-") print(report);
  return report.failed() ? 1 : 0;
}

}  // namespace

void add_hunt_options(Subcommand& command, HuntCommand& o) {
  command.option("--hunt", o.minutes,
                 "instead, minutes of random views with lights that barely reach a pixel, on one device");
  command.flag(
      "--shadow-pairs", o.shadows,
      "with --hunt: of random scenes instead, each pair of a pixel and a light that casts a shadow, and "
      "moving sequences against frames that keep nothing");
  command.flag("--cases", o.cases,
               "with --hunt: random cases of samples and of light indices instead, against their oracles");
  command.option("--contacts", o.contacts,
                 "with --hunt: ends after this many contacts instead of a time; 0: by time");
  command.option("--seed", o.seed, "with --hunt: seed of its random numbers");
  command.option("--save", o.save,
                 "with --hunt: a folder for losing views, as captured frames with the fewest lights");
}

int run_hunt(const HuntCommand& o, verify::CullEngine& engine, const std::string& filter,
             const std::string& json) {
  verify::HuntOptions options{.minutes = parse_minutes(o.minutes),
                              .contacts = o.contacts,
                              .seed = o.seed,
                              .filter = filter,
                              .few_settings = o.contacts > 0 && o.contacts < short_hunt,
                              .save = o.save,
                              .progress = progress_bar()};
  if (o.shadows && o.cases) throw input_error("verify: --cases cannot be combined with --shadow-pairs");
  if (!o.shadows && !o.cases) return tell(verify::hunt(engine, options), json);
  if (!o.save.empty())
    throw input_error("verify: --save {} cannot be combined with {}", o.save,
                      o.cases ? "--cases" : "--shadow-pairs");
  return o.cases ? tell(verify::hunt_cases(engine, options), json)
                 : tell(verify::hunt_shadows(engine, options), json);
}

}  // namespace lightgrid::app
