// lightgrid techniques: each with its summary, source and settings.
#include <fmt/format.h>

#include <cstdio>

#include "app/commands.h"
#include "techniques/technique.h"

namespace lightgrid {
namespace {

int list_techniques() {
  for (const Technique* t : techniques()) fmt::print("{:<14} {} ({})\n", t->name, t->summary, t->source);
  fmt::print("\nSettings, --set KEY=VALUE; the first value is the default:\n");
  for (const SettingHelp& s : setting_help()) fmt::print("{:<14} {}: {}\n", s.key, fmt::join(s.values, " "), s.meaning);
  return 0;
}

}  // namespace

void add_techniques(CommandLine& line) {
  line.add("techniques", "the techniques and settings there are", list_techniques);
}

}  // namespace lightgrid
