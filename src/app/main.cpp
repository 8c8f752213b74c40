// The command line: one subcommand a file, exit statuses as docs/command_line.md says.
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
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error, std::cout, std::cerr);  // help is an "error" of status 0
    return status == 0 ? 0 : int(ErrorKind::input);
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
