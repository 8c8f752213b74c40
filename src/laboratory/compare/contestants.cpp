#include "compare/contestants.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "frames/frame_culler.h"
#include "plan/settings/shadows.h"

namespace lightgrid::lab {
namespace {

// "KEY=A,B": each of the previous contestants with A, then each with B.
std::vector<BenchContestant> multiplied(const std::vector<BenchContestant>& before,
                                        const std::string& comparison) {
  const size_t equals = comparison.find('=');
  if (equals == std::string::npos) throw input_error("compare {}: not KEY=VALUE,VALUE,…", comparison);
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

void apply_own_setting(Contestant& contestant, const std::string& assignment) {
  apply_setting(contestant.settings, assignment);
  const std::string key = assignment.substr(0, assignment.find('='));
  if (!reads_setting(*contestant.technique, key)) {
    throw input_error("techniques {}:{}: {} does not read {}; it reads {}", contestant.technique->name,
                      assignment, contestant.technique->name, key,
                      fmt::join(contestant.technique->settings, ", "))
        .about(key);
  }
}

// Each contestant with each value of the settings that it reads.
std::vector<Contestant> swept(const std::vector<Contestant>& contestants,
                              const std::vector<std::string>& comparisons) {
  std::vector<Contestant> all;
  for (const Contestant& contestant : contestants) {
    std::vector<std::string> own;
    for (const std::string& comparison : comparisons) {
      if (reads_setting(*contestant.technique, comparison.substr(0, comparison.find('='))))
        own.push_back(comparison);
    }
    for (const BenchContestant& c : contestants_of(contestant.settings, own, 64)) {
      all.push_back({contestant.technique, c.settings});
    }
  }
  return all;
}

void check_comparisons(const std::vector<Contestant>& contestants,
                       const std::vector<std::string>& comparisons) {
  for (const std::string& comparison : comparisons) {
    const std::string key = comparison.substr(0, comparison.find('='));
    const auto reads = [&](const Contestant& c) { return reads_setting(*c.technique, key); };
    if (std::ranges::any_of(contestants, reads)) continue;
    throw input_error("compare {}: no technique reads {}", comparison, key);
  }
}

// Returns false if the technique does not read the setting, or no value of it changes anything while the
// others are as they are. `casts`: a light of the scene may cast shadows.
bool takes_effect(const Contestant& c, const std::string& key, bool casts) {
  const auto reads = [&](const std::string& other) { return reads_setting(*c.technique, other); };
  if (!reads(key)) return false;
  const SettingRow& row = *std::ranges::find(setting_rows(), key, &SettingRow::key);
  Settings read = only_with(c.settings, reads);
  if (row.flags.shown && !row.flags.shown(read)) return false;
  if (!row.flags.of_tiles || (casts && read[setting::shadows] != ShadowMethod::none)) return true;
  TechniqueNeeds needs = c.technique->needs;
  if (needs.adapt) needs.adapt(needs, read);
  return needs.lists.light_grid;
}

// Names a value of another setting with which this one takes effect.
std::string remedy(const Contestant& contestant, const std::string& key) {
  const std::string name = contestant.technique->name;
  for (const SettingRow& row : setting_rows()) {
    if (!reads_setting(*contestant.technique, row.key)) continue;
    for (const std::string& value : row.values) {
      Contestant other = contestant;
      apply_setting(other.settings, row.key + "=" + value);
      if (takes_effect(other, key, false)) return fmt::format("{} reads it with {}={}", name, row.key, value);
    }
  }
  return fmt::format("{} reads it only for shadows, and no light casts one", name);
}

// All are compared with one image of every light; with another BRDF or other ranges, the difference would
// count as a technique's error.
void check_same_picture(const std::vector<Contestant>& contestants) {
  const Contestant& first = contestants.front();
  auto meant = to_strings(first.settings);
  for (const Contestant& c : contestants) {
    auto other = to_strings(c.settings);
    for (const std::string& key : model_settings()) {
      const std::string &one = meant.at(json_key(key)), &another = other.at(json_key(key));
      if (one == another) continue;
      throw input_error(
          "{0}: {1} with {0}={2} and {3} with {0}={4}: one reference cannot serve both; choose one for all",
          key, first.technique->name, one, c.technique->name, another);
    }
  }
}

}  // namespace

std::vector<Contestant> named_contestants(const std::vector<std::string>& items, const Settings& common) {
  std::vector<Contestant> contestants;
  for (const std::string& item : items) {
    const size_t colon = item.find(':');
    const bool setting_only = colon == std::string::npos && item.find('=') != std::string::npos;
    if (setting_only && !contestants.empty()) {
      apply_own_setting(contestants.back(), item);
      continue;
    }
    if (item == "all") {
      for (const Technique* technique : techniques()) contestants.push_back({technique, common});
      continue;
    }
    contestants.push_back({&find_technique(item.substr(0, colon)), common});
    if (colon != std::string::npos) apply_own_setting(contestants.back(), item.substr(colon + 1));
  }
  return contestants;
}

void take_own_settings(std::string& technique, std::vector<std::string>& set) {
  std::vector<std::string> items;
  for (size_t begin = 0; begin < technique.size();) {
    const size_t end = std::min(technique.find(',', begin), technique.size());
    items.push_back(technique.substr(begin, end - begin));
    begin = end + 1;
  }
  if (items.empty()) return;
  const size_t count = named_contestants(items, {}).size();
  if (count != 1)
    throw input_error("technique {}: {} techniques; one is drawn here, and compare takes several", technique,
                      count);
  const size_t colon = technique.find(':');
  technique = technique.substr(0, colon);
  if (colon == std::string::npos) return;
  items[0] = items[0].substr(colon + 1);
  set.insert(set.end(), items.begin(), items.end());
}

void check_given_settings(const Settings& common, const std::vector<Contestant>& contestants,
                          const GivenFor& where) {
  for (const std::string& key : given_keys(common)) {
    const auto changes = [&](const Contestant& c) { return takes_effect(c, key, where.casts); };
    if (std::ranges::any_of(contestants, changes)) continue;
    if (where.grid && std::ranges::count(culling_settings(), key) > 0) continue;
    const auto reads = [&](const Contestant& c) { return reads_setting(*c.technique, key); };
    const auto reader = std::ranges::find_if(contestants, reads);
    if (reader != contestants.end())
      throw input_error("set {}: it would change nothing; {}", key, remedy(*reader, key)).about(key);
    std::vector<std::string> names;
    for (const Contestant& c : contestants) names.emplace_back(c.technique->name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const bool one = names.size() == 1;
    throw input_error(
        "set {}: {} {} not read it, and it would change nothing; lightgrid techniques --settings lists what "
        "each "
        "reads",
        key, fmt::join(names, ", "), one ? "does" : "do");
  }
}

std::vector<BenchContestant> contestants_of(const Settings& base, const std::vector<std::string>& comparisons,
                                            size_t most) {
  std::vector<BenchContestant> contestants{{"", base}};
  for (const std::string& comparison : comparisons) contestants = multiplied(contestants, comparison);
  if (contestants.size() > most)
    throw input_error("compare: {} combinations; {} at most", contestants.size(), most);
  return contestants;
}

std::vector<BenchContestant> culling_contestants(const Settings& base,
                                                 const std::vector<std::string>& comparisons, size_t most) {
  const std::vector<BenchContestant> contestants = contestants_of(base, comparisons, most);
  for (const std::string& comparison : comparisons) {
    const std::string key = comparison.substr(0, comparison.find('='));
    if (std::ranges::count(culling_settings(), key) > 0) continue;
    throw input_error("compare {}: culling does not read {}; it reads {}", comparison, key,
                      fmt::join(culling_settings(), ", "));
  }
  return contestants;
}

std::vector<Contestant> chosen_contestants(const std::vector<std::string>& techniques, const Settings& common,
                                           const std::vector<std::string>& comparisons) {
  contestants_of(common, comparisons, 64);  // reports an invalid comparison, even if no technique reads it
  const std::vector<Contestant> named = named_contestants(techniques, common);
  check_comparisons(named, comparisons);
  const std::vector<Contestant> all = swept(named, comparisons);
  check_given_settings(common, all);
  check_same_picture(all);
  return all;
}

}  // namespace lightgrid::lab
