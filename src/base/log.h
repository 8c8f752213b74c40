// Messages for people, one line each, on stderr; results go to stdout and never through here.
#pragma once

#include <fmt/format.h>

#include <string>

namespace lightgrid {

enum class LogLevel { quiet, normal, verbose };

void set_log_level(LogLevel level);

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
