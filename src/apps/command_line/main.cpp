// The command line: one subcommand a file, exit statuses as in docs/command_line.md.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/message_line.h"
#include "cl/cache_folder.h"
#include "cl/error.h"
#include "command_line/commands.h"
#include "command_line/environment.h"
#include "command_line/progress.h"
#include "command_line/sudden_ends.h"

namespace {

// A closed stream's number would go to the next file that is opened, into which the program would then print.
// On this device a write to stdout or stderr still fails.
void reserve_standard_streams() {
  for (int stream = 0; stream <= 2; ++stream) {
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDONLY);
  }
}

// Throws if not everything that was printed could be written. `code`: the errno of an earlier failure, if
// known.
void check_stdout(int code = 0) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  if (!errno && !code) {
    std::fputc('\n', stdout);
    std::fflush(stdout);  // fails for the same reason
  }
  if (errno) code = errno;
  throw lightgrid::machine_error("stdout: cannot be written: {}", std::strerror(code ? code : EIO));
}

// As the user gave it, without what `frontier` adds for one of its processes.
std::vector<std::string> command_to_copy(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  const auto process = std::find(words.begin(), words.end(), "--process");
  if (process != words.end()) words.erase(process, std::min(process + 2, words.end()));
  return words;
}

int run(const lightgrid::app::Command& command) {
  try {
    const int status = command();
    check_stdout();
    return status;
  } catch (const std::system_error& error) {
    check_stdout(error.code().value());  // fmt::print throws these
    throw;
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace lightgrid;
  using namespace lightgrid::app;
  reserve_standard_streams();
  prepare_environment();
  const TemporaryCache cache;
  const SuddenEnds ends(pocl_cache_folder());
  CommandLine line("lightgrid",
                   "lightgrid: scenes with very many lights: accuracy and time of each technique");
  for (const auto add : {add_render, add_compare, add_plan, add_capture, add_cull, add_inspect, add_info,
                         add_scenes, add_techniques, add_devices, add_bench, add_verify, add_view,
                         add_frontier, add_which, add_golden, add_check, add_reference, add_manual})
    add(line);
  const Command command = line.parse(argc, argv);
  set_command(command_to_copy(argc, argv));
  if (line.quiet()) set_log_level(LogLevel::quiet);
  cache.tell();
  const ProgressLines lines(argc > 1 ? argv[1] : "", line.quiet());
  try {
    return run(command);
  } catch (const Error& error) {
    std::fprintf(stderr, "lightgrid: %s\n", message_line(line.with_option(error.what())).c_str());
    return error.exit_code();
  } catch (const cl::Error& error) {
    std::fprintf(stderr, "lightgrid: %s\n", message_line(cl_machine_error(error).what()).c_str());
  } catch (const std::bad_alloc&) {
    std::fputs(out_of_memory_line.data(), stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lightgrid: %s\n", message_line(error.what()).c_str());
  }
  return int(ErrorKind::machine);
}
