// One file per subcommand. Each add_… adds its subcommand and options; when the command line names it, `chosen`
// becomes what main.cpp then runs. That returns the exit status: 0 done, 1 a failure was found that was looked
// for; what a user or the machine got wrong is thrown (base/error.h).
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace lightgrid {

using Command = std::function<int()>;

void add_render(CLI::App& app, Command& chosen);
void add_compare(CLI::App& app, Command& chosen);
void add_plan(CLI::App& app, Command& chosen);
void add_scenes(CLI::App& app, Command& chosen);
void add_techniques(CLI::App& app, Command& chosen);
void add_devices(CLI::App& app, Command& chosen);

}  // namespace lightgrid
