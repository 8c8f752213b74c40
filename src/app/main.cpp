// The command line: one subcommand a file, exit statuses as in docs/command_line.md.
#include <cstdio>
#include <new>

#include "app/commands.h"
#include "app/environment.h"
#include "app/progress.h"
#include "app/temporary_cache.h"
#include "base/error.h"
#include "base/log.h"
#include "cl/error.h"

int main(int argc, char** argv) {
  using namespace lightgrid;
  prepare_environment();
  const TemporaryCache cache;
  CommandLine line("lightgrid",
                   "lightgrid: scenes with very many lights: accuracy and time of each technique");
  for (const auto add : {add_render, add_compare, add_plan, add_capture, add_cull, add_inspect, add_scenes,
                         add_techniques, add_devices, add_bench, add_verify, add_view, add_frontier})
    add(line);
  const Command command = line.parse(argc, argv);
  if (line.quiet()) set_log_level(LogLevel::quiet);
  cache.tell();
  const ProgressLines lines(argc > 1 ? argv[1] : "");
  try {
    return command();
  } catch (const Error& error) {
    std::fprintf(stderr, "lightgrid: %s\n", line.with_option(error.what()).c_str());
    return error.exit_code();
  } catch (const cl::Error& error) {
    std::fprintf(stderr, "lightgrid: %s\n", cl_machine_error(error).what());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "lightgrid: out of memory; a smaller --size, scene or number of lights would help\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lightgrid: %s\n", error.what());
  }
  return int(ErrorKind::machine);
}
