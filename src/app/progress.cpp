#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace lightgrid {
namespace {

void show_progress(double done, const std::string& step) {
  constexpr int width = 24, text = 32;
  const int filled = int(done * width);
  fmt::print(stderr, "\r[{}{}] {:<{}.{}}", std::string(filled, '#'), std::string(width - filled, '.'), step, text, text);
  if (done >= 1) fmt::print(stderr, "\r{:{}}\r", "", width + text + 3);
}

}  // namespace

std::function<void(double, const std::string&)> progress_bar() {
  if (!isatty(STDERR_FILENO)) return nullptr;
  return show_progress;
}

}  // namespace lightgrid
