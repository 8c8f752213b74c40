// The command line: one subcommand a file, exit statuses as docs/command_line.md says.
#include <algorithm>
#include <cstdio>
#include <new>

#include "app/commands.h"
#include "base/error.h"
#include "base/log.h"

int main(int argc, char** argv) {
  using namespace lightgrid;
  CLI::App app{"lightgrid: scenes with very many lights, and what each technique's accuracy costs in time", "lightgrid"};
  app.require_subcommand(1);
  app.fallthrough();
  bool quiet = false;
  app.add_flag("--quiet", quiet, "errors only on stderr");
  Command chosen;
  for (const auto add : {add_render, add_compare, add_plan, add_scenes, add_techniques, add_devices}) add(app, chosen);
  try {
    // Said before the parser says only that a command is missing.
    const auto is_command = [&](const std::string& name) {
      return !app.get_subcommands([&](const CLI::App* c) { return c->get_name() == name; }).empty();
    };
    if (argc > 1 && argv[1][0] != '-' && !is_command(argv[1])) throw CLI::ExtrasError({argv[1]});
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);  // help is an "error" too
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::fprintf(stderr, "lightgrid: %s (--help tells more)\n", line.c_str());
    return int(ErrorKind::input);
  }
  if (quiet) set_log_level(LogLevel::quiet);
  try {
    return chosen();
  } catch (const Error& error) {
    std::fprintf(stderr, "lightgrid: %s\n", error.what());
    return error.exit_code();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "lightgrid: out of memory; a smaller --size, scene or number of lights would help\n");
    return int(ErrorKind::machine);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lightgrid: %s\n", error.what());
    return int(ErrorKind::machine);
  }
}
