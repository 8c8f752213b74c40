#include "command_line/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/compiling.h"
#include "base/log.h"
#include "base/timer.h"

namespace lightgrid::app {
namespace {

constexpr int width = 20, text = 40, rest = 14, columns = width + text + rest + 4;

// The text of the lines. Written by the working thread, read by the printing thread.
struct State {
  std::mutex mutex;
  std::string command, step;
  double done = 0;
  std::string bar;  // as last drawn on a terminal; empty: none, or cleared
  // Without a terminal: for their first time on this machine.
  int kernels_compiled = 0, kernels_total = 0, kernels_printed = 0;
  // Kernels and shaders that were compiled, on whichever start, and the last one's file.
  std::string file;
  int files = 0, files_printed = 0;
};

State& state() {
  static State* const shared = new State;  // outlives every thread
  return *shared;
}

std::string in_words(double seconds) {
  return seconds < 90 ? fmt::format("{:.0f} s", std::ceil(seconds))
                      : fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

// Estimated from the time so far, if that is long enough: "about 3 min".
std::string time_left(double done, double seconds) {
  return seconds < 3 || done < 0.02 ? "" : "about " + in_words(seconds * (1 - done) / done);
}

std::string compiling_words(int kernels, int total) {
  return fmt::format("compiling kernels for this machine, first time only: {} of {}", kernels, total);
}

// Replaces the terminal's last line.
void print_over(const std::string& line) { fmt::print(stderr, "\r{:<{}}", line, columns); }

void show_on_terminal(int kernels, int total) {
  if (kernels > 0) return print_over(compiling_words(kernels, total));
  const std::lock_guard lock(state().mutex);
  print_over(state().bar);
  if (state().bar.empty()) fmt::print(stderr, "\r");
}

void note_for_lines(int kernels, int total) {
  if (kernels == 0) return;
  const std::lock_guard lock(state().mutex);
  state().kernels_compiled = kernels;
  state().kernels_total = total;
}

void note_file(const std::string& file) {
  const std::lock_guard lock(state().mutex);
  state().file = file;
  ++state().files;
}

// Of a line without a terminal. Call it with the mutex locked.
std::string current_step() {
  State& s = state();
  const bool first = s.kernels_compiled > s.kernels_printed, any = s.files > s.files_printed;
  s.kernels_printed = s.kernels_compiled;
  s.files_printed = s.files;
  if (first) return compiling_words(s.kernels_compiled, s.kernels_total);
  // No kernel counts as a first one if there is no disk cache (LIGHTGRID_CL_CACHE).
  if (any) return fmt::format("compiling {} ({} so far)", s.file, s.files);
  if (s.step.empty()) return "finishing";
  // PoCL compiles some kernels only when they are launched.
  const bool only_command = s.step == s.command && s.files > 0;
  return only_command ? fmt::format("{}, {} kernels and shaders compiled so far", s.step, s.files) : s.step;
}

double interval_s() {
  const char* given = std::getenv("LIGHTGRID_PROGRESS_S");
  const double seconds = given ? std::atof(given) : 0;
  return seconds > 0 ? seconds : 10;
}

}  // namespace

std::function<void(double, const std::string&)> progress_bar() {
  if (!isatty(STDERR_FILENO)) {
    return [](double done, const std::string& step) {
      const std::lock_guard lock(state().mutex);
      state().done = done;
      state().step = step;
    };
  }
  return [timer = Timer()](double done, const std::string& step) {
    const std::lock_guard lock(state().mutex);
    const int filled = int(done * width);
    state().bar = done >= 1 ? ""
                            : fmt::format("[{}{}] {:<{}.{}} {}", std::string(filled, '#'),
                                          std::string(width - filled, '.'), step, text, text,
                                          time_left(done, timer.elapsed_ms() / 1000));
    print_over(state().bar);
    if (state().bar.empty()) fmt::print(stderr, "\r");
  };
}

ProgressLines::ProgressLines(const std::string& command, bool quiet) {
  if (quiet || command == "view") return;  // a window shows what it does
  const bool terminal = isatty(STDERR_FILENO);
  set_first_compilation_function(terminal ? show_on_terminal : note_for_lines);
  if (terminal) return;
  before_compiling = note_file;
  state().step = state().command = command;
  thread_ = std::thread([this] { run(std::chrono::duration<double>(interval_s())); });
}

ProgressLines::~ProgressLines() {
  set_first_compilation_function({});
  if (!thread_.joinable()) return;
  before_compiling = nullptr;
  {
    const std::lock_guard lock(ending_);
    ended_ = true;
  }
  end_.notify_one();
  thread_.join();
}

void ProgressLines::run(std::chrono::duration<double> interval) {
  const Timer timer;
  std::unique_lock lock(ending_);
  while (!end_.wait_for(lock, interval, [this] { return ended_; })) {
    const double seconds = timer.elapsed_ms() / 1000;
    const std::lock_guard reading(state().mutex);
    const std::string left =
        state().done > 0 && state().done < 1 ? fmt::format(", {:.0f} % done", 100 * state().done) : "";
    log_info("after {:.0f} s{}: {}", std::ceil(seconds), left, current_step());
  }
}

}  // namespace lightgrid::app
