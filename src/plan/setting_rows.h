// The rows of the table of settings, which only settings.cpp reads.
#pragma once

#include "plan/settings.h"

namespace lightgrid {

struct SettingChoice {
  std::string value;
  std::function<void(Settings&)> set;
  std::function<bool(const Settings&)> is_set;
};

struct SettingValues {
  std::vector<SettingChoice> choices;  // the default first
  std::function<void(Settings& to, const Settings& from)> copy;
  std::function<bool(const Settings&, const Settings&)> same;
  double LightRanges::*number = nullptr;  // any number besides the choices
};

struct SettingRow {
  std::string key, meaning;
  SettingValues values;
  SettingFlags flags{};
};

std::vector<SettingRow>& all_settings();

}  // namespace lightgrid
