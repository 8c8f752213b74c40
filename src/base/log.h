// Messages for people, one line each, on stderr; results go to stdout and never through here.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

namespace lightgrid {

enum class LogLevel { quiet, normal, verbose };

void set_log_level(LogLevel level);

// Lines go to `sink` instead of stderr; empty: to stderr again. For programs that this is a library of. Lines
// of two threads do not overlap.
using LogSink = std::function<void(bool warning, const std::string& line)>;
void set_log_sink(LogSink sink);

void log_info_line(const std::string& line);
void log_warning_line(const std::string& line);

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_info_line(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_warning_line(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lightgrid
