// Errors and warnings of one input file, each a single line that starts with its name.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/message_line.h"

namespace lightgrid::gltf {

class Reporter {
 public:
  explicit Reporter(std::string file) : file_(std::move(file)) {}

  template <typename... Args>
  Error error(fmt::format_string<Args...> format, Args&&... args) const {
    return {ErrorKind::input, message_line(file_ + ": " + fmt::format(format, std::forward<Args>(args)...))};
  }

  // For messages of others.
  std::string place(const std::string& within) const { return message_line(file_ + ": " + within); }

  // Only the first of each kind: a thousand skinned meshes give one line.
  template <typename... Args>
  void warn(const std::string& kind, fmt::format_string<Args...> format, Args&&... args) {
    if (!warned_.insert(kind).second) return;
    log_warning_line(message_line(file_ + ": " + fmt::format(format, std::forward<Args>(args)...)));
  }

  // The faults of optional parts of one kind, each of which is left out. Only the first is named.
  static void warn_left_out(const std::vector<Error>& faults, const char* kind) {
    if (faults.empty()) return;
    const size_t others = faults.size() - 1;
    const std::string rest = others ? fmt::format(", and {} more", others) : "";
    log_warning_line(fmt::format("{}; this {} is left out{}", faults[0].what(), kind, rest));
  }

 private:
  std::string file_;
  std::set<std::string> warned_;
};

// mesh 3 "lamp", or mesh 3 if it has no name.
inline std::string label(const char* kind, int index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} \"{}\"", kind, index, name);
}

}  // namespace lightgrid::gltf
