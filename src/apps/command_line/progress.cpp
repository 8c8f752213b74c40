#include "command_line/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/log.h"
#include "base/timer.h"

namespace lightgrid::app {
namespace {

constexpr int width = 20, text = 40, rest = 14;

// The text of the lines. Written by the working thread, read by the printing thread.
struct State {
  std::mutex mutex;
  std::string step;
  double done = 0;
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
    const int filled = int(done * width);
    fmt::print(stderr, "\r[{}{}] {:<{}.{}} {:<{}}", std::string(filled, '#'),
               std::string(width - filled, '.'), step, text, text, time_left(done, timer.elapsed_ms() / 1000),
               rest);
    if (done >= 1) fmt::print(stderr, "\r{:{}}\r", "", width + text + rest + 4);
  };
}

ProgressLines::ProgressLines(const std::string& command) {
  if (isatty(STDERR_FILENO) || command == "view") return;  // a window shows what it does
  state().step = command;
  thread_ = std::thread([this] { run(std::chrono::duration<double>(interval_s())); });
}

ProgressLines::~ProgressLines() {
  if (!thread_.joinable()) return;
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
    log_info("after {:.0f} s{}: {}", std::ceil(seconds), left,
             state().step.empty() ? "finishing" : state().step);
  }
}

}  // namespace lightgrid::app
