#include "base/log.h"

#include "base/message_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <utility>

namespace lightgrid {
namespace {

spdlog::logger& logger() {
  static const auto instance = [] {
    auto made = spdlog::stderr_color_mt("lightgrid");
    made->set_pattern("%^%l:%$ %v");
    return made;
  }();
  return *instance;
}

struct Sink {
  std::mutex mutex;
  LogSink write;
};

Sink& sink() {
  static Sink* const shared = new Sink;  // outlives every thread
  return *shared;
}

void log_line(bool warning, const std::string& text) {
  const std::string line = message_line(text);
  const std::lock_guard lock(sink().mutex);
  if (sink().write) return sink().write(warning, line);
  warning ? logger().warn(line) : logger().info(line);
}

}  // namespace

void set_log_sink(LogSink write) {
  const std::lock_guard lock(sink().mutex);
  sink().write = std::move(write);
}

void set_log_level(LogLevel level) {
  logger().set_level(level == LogLevel::quiet     ? spdlog::level::err
                     : level == LogLevel::verbose ? spdlog::level::debug
                                                  : spdlog::level::info);
}

void log_info_line(const std::string& line) { log_line(false, line); }
void log_warning_line(const std::string& line) { log_line(true, line); }

}  // namespace lightgrid
