#include "base/log.h"

#include "base/message_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>
#include <set>
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
  std::string command;         // empty: a library's process
  std::set<std::string> once;  // warnings that a program has printed
};

Sink& sink() {
  static Sink* const shared = new Sink;  // outlives every thread
  return *shared;
}

thread_local WarningCollector* innermost = nullptr;

// In single quotes where a shell would read more than a word.
std::string shell_word(const std::string& word) {
  const auto plain = [](char c) {
    return std::isalnum(uint8_t(c)) || uint8_t(c) >= 0x80 ||
           std::string_view("_-+=.,:/@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void log_line(bool warning, const std::string& text) {
  const std::string line = message_line(text);
  const std::lock_guard lock(sink().mutex);
  if (sink().write) return sink().write(warning, line);
  if (warning && !sink().command.empty() && !sink().once.insert(line).second) return;
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

void log_warning_line(const std::string& line, const std::vector<std::string>& settings) {
  if (innermost) {
    Warning warning{message_line(line), settings};
    const std::lock_guard lock(sink().mutex);
    if (!settings.empty() && !sink().command.empty()) {
      warning.command = sink().command;
      for (const std::string& setting : settings) warning.command += " --set " + shell_word(setting);
    }
    for (WarningCollector* c = innermost; c; c = c->outer()) c->add(warning);
  }
  log_line(true, line);
}

void set_command(const std::vector<std::string>& words) {
  const std::lock_guard lock(sink().mutex);
  sink().command.clear();
  for (const std::string& word : words)
    sink().command += (sink().command.empty() ? "" : " ") + shell_word(word);
}

WarningCollector::WarningCollector() : outer_(innermost) { innermost = this; }
WarningCollector::~WarningCollector() { innermost = outer_; }
void WarningCollector::add(const Warning& warning) { add_distinct(warnings_, {warning}); }

void add_distinct(std::vector<Warning>& to, const std::vector<Warning>& from) {
  for (const Warning& warning : from)
    if (std::ranges::find(to, warning) == to.end()) to.push_back(warning);
}

}  // namespace lightgrid
