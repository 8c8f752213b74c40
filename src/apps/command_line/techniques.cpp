// lightgrid techniques: each with its summary, source and settings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "command_line/commands.h"
#include "command_line/options.h"
#include "run/tables.h"
#include "techniques/technique.h"

namespace lightgrid::app {
namespace {

// "tile=16 slices=24": the keys with their defaults.
std::string with_defaults(const std::vector<const char*>& keys) {
  std::vector<std::string> words;
  for (const char* key : keys) {
    for (const SettingRow& s : setting_rows()) {
      if (s.key == key) words.push_back(s.key + "=" + s.values.front());
    }
  }
  return fmt::format("{}", fmt::join(words, " "));
}

constexpr int column = 22;

// Settings that change pictures and times most, for newcomers.
constexpr std::array first_settings = {"samples", "shadows", "range", "cutoff", "raster"};

void print_setting(const SettingRow& s) {
  fmt::print("{:<{}}{}{}: {}\n", s.key, column, fmt::join(s.values, " "),
             s.flags.any_number ? " or any number" : "", s.meaning);
}

void print_techniques(bool all) {
  for (const Technique* t : techniques()) {
    fmt::print("{:<{}}{}\n", t->name, column, t->summary);
    fmt::print("{:<{}}source: {}\n", "", column, t->source);
    if (all && !t->settings.empty())
      fmt::print("{:<{}}settings: {}\n", "", column, with_defaults(t->settings));
  }
  if (all) fmt::print("{:<{}}settings: {}\n", "(all of them)", column, with_defaults(common_settings()));
  fmt::print(
      "\nSettings: --set KEY=VALUE, or NAME:KEY=VALUE in compare -t; the first value is the default:\n");
  for (const SettingRow& s : setting_rows())
    if (all || std::ranges::count(first_settings, s.key) > 0) print_setting(s);
  if (!all)
    fmt::print("{} more: lightgrid techniques --settings\n", setting_rows().size() - first_settings.size());
}

int list_techniques(const std::string& json, bool all) {
  if (json.empty()) {
    print_techniques(all);
  } else {
    write_json(json, techniques_json().dump(1));
  }
  return 0;
}

}  // namespace

void add_techniques(CommandLine& line) {
  auto json = std::make_shared<std::string>();
  auto all = std::make_shared<bool>(false);
  Subcommand command = line.add("techniques", "the available techniques and settings",
                                [json, all] { return list_techniques(*json, *all); });
  command.flag("--settings", *all, "the settings that each technique reads, and all settings");
  command.option("--json", *json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
