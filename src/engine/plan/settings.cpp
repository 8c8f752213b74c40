#include "plan/settings.h"

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "base/text.h"
// Rows that every program has which applies settings.
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/masks.h"
#include "plan/settings/model.h"
#include "plan/settings/picture.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "plan/settings/surfaces.h"

namespace lightgrid {
namespace {

constexpr double min_number = 1e-9, max_number = 1e9;

// Only static objects change it, before main or while a library is loaded.
std::vector<SettingRow>& rows() {
  static std::vector<SettingRow> all;
  return all;
}

std::vector<std::string> keys_of(const auto& holds) {
  std::vector<std::string> keys;
  for (const SettingRow& row : rows()) {
    if (holds(row)) keys.push_back(row.key);
  }
  return keys;
}

std::vector<std::string> keys_with(bool SettingFlags::*flag) {
  return keys_of([=](const SettingRow& row) { return row.flags.*flag; });
}

// Returns whether the value has that name.
bool set_named(Settings& settings, const SettingRow& row, const std::string& value) {
  const auto named = std::ranges::find(row.values, value);
  if (named == row.values.end()) return false;
  settings.set_difference(row, row.bits[size_t(named - row.values.begin())] ^ row.bits.front());
  return true;
}

bool set_number(Settings& settings, const SettingRow& row, const std::string& value) {
  const auto number = row.flags.any_number ? parse_number<double>(value) : std::nullopt;
  if (!number || !(*number >= min_number && *number <= max_number)) return false;
  settings.set_difference(row, setting_bits(*number) ^ row.bits.front());
  return true;
}

std::string string_of(const Settings& settings, const SettingRow& row) {
  const uint64_t bits = settings.difference(row) ^ row.bits.front();
  const auto named = std::ranges::find(row.bits, bits);
  if (named != row.bits.end()) return row.values[size_t(named - row.bits.begin())];
  return row.flags.any_number ? fmt::format("{}", FromSettingBits<double>::value(bits)) : "";
}

}  // namespace

SettingNumber add_unlisted_setting() {
  static size_t count = 0;
  if (count == Settings::max_settings) std::abort();
  return {count++};
}

SettingNumber add_setting(SettingRow row) {
  row.number = add_unlisted_setting().number;
  const SettingNumber added = row;
  rows().insert(std::ranges::upper_bound(rows(), row.place, {}, &SettingRow::place), std::move(row));
  return added;
}

void apply_setting(Settings& settings, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  if (key == "shadow-kept")
    throw input_error(
        "set {}: shadow-kept was removed: it saved no time while the camera moved, and shadows leaked; "
        "shadow-reuse=on keeps shadows while nothing changes",
        assignment);
  const auto row = std::ranges::find(rows(), key, &SettingRow::key);
  if (equals == std::string::npos || row == rows().end()) {
    const std::vector<std::string> keys = keys_of([](const SettingRow&) { return true; });
    throw input_error("set {}: not KEY=VALUE with a known key{}; keys are {}", assignment,
                      did_you_mean(key, keys), fmt::join(keys, ", "));
  }
  const std::string value = assignment.substr(equals + 1);
  if (set_named(settings, *row, value) || set_number(settings, *row, value)) {
    settings.give(*row);
    return;
  }
  if (row->flags.any_number)
    throw input_error("set {}: {} is a number from {:g} to {:g}", assignment, key, min_number, max_number);
  throw input_error("set {}: \"{}\" is not a value of {}{}; values are {}", assignment, value, key,
                    did_you_mean(value, row->values), fmt::join(row->values, ", "));
}

std::vector<std::string> given_keys(const Settings& settings) {
  std::vector<std::string> keys = keys_of([&](const SettingRow& row) { return settings.given(row); });
  std::ranges::sort(keys);
  return keys;
}

const std::vector<std::string>& model_settings() {
  static const std::vector<std::string> keys = keys_with(&SettingFlags::model);
  return keys;
}

bool same_model(const Settings& a, const Settings& b) {
  return std::ranges::all_of(rows(), [&](const SettingRow& row) {
    return !row.flags.model || a.difference(row) == b.difference(row);
  });
}

Settings with_model(Settings settings, const Settings& model) {
  for (const SettingRow& row : rows()) {
    if (row.flags.model) settings.copy(row, model);
  }
  return settings;
}

Settings meant_by(Settings settings) {
  for (const SettingRow& row : rows()) {
    if (row.flags.mean) row.flags.mean(settings);
  }
  return settings;
}

Settings only_with(Settings settings, const std::function<bool(const std::string&)>& keeps) {
  for (const SettingRow& row : rows()) {
    if (!keeps(row.key)) settings.reset(row);
  }
  return settings;
}

const std::vector<std::string>& tunable_settings() {
  static const std::vector<std::string> keys = keys_with(&SettingFlags::tunable);
  return keys;
}

Settings with_tuned(Settings settings, const std::map<std::string, std::string>& tuned) {
  for (const SettingRow& row : rows()) {
    const auto found = tuned.find(row.key);
    if (found != tuned.end() && !settings.given(row) && row.flags.tunable)
      set_named(settings, row, found->second);
  }
  return settings;
}

std::string json_key(std::string setting) {
  std::ranges::replace(setting, '-', '_');
  return setting;
}

std::map<std::string, std::string> to_strings(const Settings& settings) {
  std::map<std::string, std::string> strings;
  for (const SettingRow& row : rows()) {
    std::string value = string_of(settings, row);
    if (!value.empty()) strings[json_key(row.key)] = std::move(value);
  }
  return strings;
}

const std::vector<SettingRow>& setting_rows() { return rows(); }

}  // namespace lightgrid
