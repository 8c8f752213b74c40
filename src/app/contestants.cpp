#include "app/contestants.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "capture/frame_culler.h"

namespace lightgrid {
namespace {

// "KEY=A,B" of --compare: each of the previous contestants with A, then each with B.
std::vector<BenchContestant> multiplied(const std::vector<BenchContestant>& before, const std::string& comparison) {
  const size_t equals = comparison.find('=');
  if (equals == std::string::npos) throw input_error("--compare {}: not KEY=VALUE,VALUE,…", comparison);
  const std::string key = comparison.substr(0, equals + 1);
  std::vector<BenchContestant> after;
  for (size_t begin = equals + 1; begin <= comparison.size();) {
    const size_t end = std::min(comparison.find(',', begin), comparison.size());
    const std::string assignment = key + comparison.substr(begin, end - begin);
    for (BenchContestant contestant : before) {
      apply_setting(contestant.settings, assignment);
      contestant.compared += (contestant.compared.empty() ? "" : " ") + assignment;
      after.push_back(contestant);
    }
    begin = end + 1;
  }
  return after;
}

}  // namespace

std::vector<BenchContestant> contestants_of(const Settings& base, const std::vector<std::string>& comparisons,
                                            size_t most) {
  std::vector<BenchContestant> contestants{{"", base}};
  for (const std::string& comparison : comparisons) contestants = multiplied(contestants, comparison);
  if (contestants.size() > most) throw input_error("--compare: {} combinations; {} at most", contestants.size(), most);
  return contestants;
}

std::vector<BenchContestant> culling_contestants(const Settings& base, const std::vector<std::string>& comparisons,
                                                 size_t most) {
  const std::vector<BenchContestant> contestants = contestants_of(base, comparisons, most);
  for (const std::string& comparison : comparisons) {
    const std::string key = comparison.substr(0, comparison.find('='));
    if (std::ranges::count(culling_settings(), key) > 0) continue;
    throw input_error("--compare {}: culling does not read {}; it reads {}", comparison, key,
                      fmt::join(culling_settings(), ", "));
  }
  return contestants;
}

}  // namespace lightgrid
