// Messages for people, one line each, on stderr; results go to stdout and never through here.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

namespace lightgrid {

enum class LogLevel { quiet, normal, verbose };

void set_log_level(LogLevel level);

// Lines go to `sink` instead of stderr; empty: to stderr again. For programs that this is a library of. Lines
// of two threads do not overlap.
using LogSink = std::function<void(bool warning, const std::string& line)>;
void set_log_sink(LogSink sink);

void log_info_line(const std::string& line);
// `settings`: "KEY=VALUE" each, with which the warning would not come.
void log_warning_line(const std::string& line, const std::vector<std::string>& settings = {});

// A warning as results have it. `command`: this process's command with `settings` appended, to copy; empty
// without settings, and in a library, which has no command.
struct Warning {
  std::string text;
  std::vector<std::string> settings = {};
  std::string command = {};
  bool operator==(const Warning&) const = default;
};

// The words with which a shell starts this process; `--set KEY=VALUE` can be appended. A program that sets
// them prints each warning once.
void set_command(const std::vector<std::string>& words);

// Collects the warnings of this thread while the object exists, each once. Objects may be nested: all of them
// collect.
class WarningCollector {
 public:
  WarningCollector();
  ~WarningCollector();
  WarningCollector(const WarningCollector&) = delete;
  WarningCollector& operator=(const WarningCollector&) = delete;
  const std::vector<Warning>& warnings() const { return warnings_; }
  void add(const Warning& warning);
  WarningCollector* outer() const { return outer_; }

 private:
  WarningCollector* const outer_;
  std::vector<Warning> warnings_;
};

void add_distinct(std::vector<Warning>& to, const std::vector<Warning>& from);

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_info_line(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_warning_line(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace lightgrid
