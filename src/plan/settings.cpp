#include "plan/settings.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "plan/setting_rows.h"

namespace lightgrid {

constexpr double least_number = 1e-9, most_number = 1e9;

void add_own_setting(const char* key, const char* before, const char* meaning,
                     const std::vector<std::string>& names, const SettingFlags& flags) {
  const auto own = [of_lights = flags.of_lights](auto& s) -> auto& {
    return of_lights ? s.ranges.effects : s.own;
  };
  const auto number_of = [=](const Settings& s) { return own(s).contains(key) ? own(s).at(key) : 0; };
  SettingValues values{
      .copy = [=](Settings& to, const Settings& from) { own(to)[key] = number_of(from); },
      .same = [=](const Settings& a, const Settings& b) { return number_of(a) == number_of(b); }};
  for (size_t i = 0; i < names.size(); ++i) {
    values.choices.push_back({names[i], [=](Settings& s) { own(s)[key] = i; },
                              [=](const Settings& s) { return number_of(s) == i; }});
  }
  all_settings().insert(std::ranges::find(all_settings(), before, &SettingRow::key),
                        {key, meaning, std::move(values), flags});
}

void apply_setting(Settings& settings, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  if (key == "shadow-kept")
    throw input_error(
        "set {}: shadow-kept was removed: it saved no time while the camera moved, and shadows leaked; "
        "shadow-reuse=on keeps shadows while nothing changes",
        assignment);
  const auto& all = all_settings();
  const auto setting =
      std::find_if(all.begin(), all.end(), [&](const SettingRow& s) { return s.key == key; });
  if (equals == std::string::npos || setting == all.end()) {
    std::vector<std::string> keys;
    for (const SettingRow& s : all) keys.push_back(s.key);
    throw input_error("set {}: not KEY=VALUE with a known key{}; keys are {}", assignment,
                      did_you_mean(key, keys), fmt::join(keys, ", "));
  }
  const std::string value = assignment.substr(equals + 1);
  std::vector<std::string> values;
  for (const SettingChoice& c : setting->values.choices) {
    if (c.value == value) {
      settings.given.insert(key);
      return c.set(settings);
    }
    values.push_back(c.value);
  }
  const auto number = setting->values.number ? parse_number<double>(value) : std::nullopt;
  if (number && *number >= least_number && *number <= most_number) {
    settings.given.insert(key);
    settings.ranges.*setting->values.number = *number;
    return;
  }
  if (setting->values.number)
    throw input_error("set {}: {} is a number from {:g} to {:g}", assignment, key, least_number, most_number);
  throw input_error("set {}: \"{}\" is not a value of {}{}; values are {}", assignment, value, key,
                    did_you_mean(value, values), fmt::join(values, ", "));
}

static std::vector<std::string> keys_with(bool SettingFlags::*flag) {
  std::vector<std::string> keys;
  for (const SettingRow& s : all_settings()) {
    if (s.flags.*flag) keys.push_back(s.key);
  }
  return keys;
}

const std::vector<std::string>& model_settings() {
  static const std::vector<std::string> keys = keys_with(&SettingFlags::model);
  return keys;
}

bool same_model(const Settings& a, const Settings& b) {
  return std::ranges::all_of(all_settings(),
                             [&](const SettingRow& s) { return !s.flags.model || s.values.same(a, b); });
}

Settings with_model(Settings settings, const Settings& model) {
  for (const SettingRow& s : all_settings()) {
    if (s.flags.model) s.values.copy(settings, model);
  }
  return settings;
}

Settings meant_by(Settings settings) {
  for (const SettingRow& s : all_settings()) {
    if (s.flags.mean) s.flags.mean(settings);
  }
  return settings;
}

Settings only_with(Settings settings, const std::function<bool(const std::string&)>& keeps) {
  for (const SettingRow& s : all_settings()) {
    if (!keeps(s.key)) s.values.copy(settings, Settings{});
  }
  return settings;
}

int most_stencil_groups(VolumeCulling culling) { return culling == VolumeCulling::stencil ? 7 : 8; }

Settings with_samples(Settings settings, int samples) {
  settings.samples = samples, settings.given.insert("samples");
  return settings;
}

Settings with_exact_shadows(Settings settings) {
  settings.shadows = ShadowMethod::exact, settings.shadow_threshold = 0;
  return settings;
}

const std::vector<std::string>& tunable_settings() {
  static const std::vector<std::string> keys = keys_with(&SettingFlags::tunable);
  return keys;
}

Settings with_tuned(Settings settings, const std::map<std::string, std::string>& tuned) {
  for (const SettingRow& s : all_settings()) {
    const auto found = tuned.find(s.key);
    if (found == tuned.end() || settings.given.contains(s.key) || !s.flags.tunable) continue;
    for (const SettingChoice& c : s.values.choices) {
      if (c.value == found->second) c.set(settings);
    }
  }
  return settings;
}

std::string json_key(std::string setting) {
  std::ranges::replace(setting, '-', '_');
  return setting;
}

std::map<std::string, std::string> to_strings(const Settings& settings) {
  std::map<std::string, std::string> strings;
  for (const SettingRow& s : all_settings()) {
    if (s.values.number) strings[json_key(s.key)] = fmt::format("{}", settings.ranges.*s.values.number);
    for (const SettingChoice& c : s.values.choices) {
      if (c.is_set(settings)) strings[json_key(s.key)] = c.value;
    }
  }
  return strings;
}

const std::vector<SettingHelp>& setting_help() {
  static const auto help = [] {
    std::vector<SettingHelp> rows;
    for (const SettingRow& s : all_settings()) {
      SettingHelp& row =
          rows.emplace_back(SettingHelp{s.key, {}, s.meaning, s.values.number != nullptr, s.flags});
      for (const SettingChoice& c : s.values.choices) row.values.push_back(c.value);
    }
    return rows;
  }();
  return help;
}

}  // namespace lightgrid
