#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "base/timer.h"

namespace lightgrid {
namespace {

constexpr int width = 20, text = 40, rest = 14;

// By what has passed, once that says something: "about 3 min".
std::string time_left(double done, double seconds) {
  if (seconds < 3 || done < 0.02) return "";
  const double left = seconds * (1 - done) / done;
  return left < 90 ? fmt::format("about {:.0f} s", std::ceil(left)) : fmt::format("about {:.0f} min", std::ceil(left / 60));
}

}  // namespace

std::function<void(double, const std::string&)> progress_bar() {
  if (!isatty(STDERR_FILENO)) return nullptr;
  return [timer = Timer()](double done, const std::string& step) {
    const int filled = int(done * width);
    fmt::print(stderr, "\r[{}{}] {:<{}.{}} {:<{}}", std::string(filled, '#'), std::string(width - filled, '.'), step, text,
               text, time_left(done, timer.elapsed_ms() / 1000), rest);
    if (done >= 1) fmt::print(stderr, "\r{:{}}\r", "", width + text + rest + 4);
  };
}

}  // namespace lightgrid
