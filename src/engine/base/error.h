// The one exception type for faults that a user or a machine can cause. Faults of our own code assert.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace lightgrid {

// Whose fault it is; the number is the exit code of the program and the status of the C interface.
enum class ErrorKind {
  input = 2,    // the arguments or a file are wrong; the message names the file, the field and the value
  machine = 3,  // this machine cannot do it (no device, out of memory); the message says what would help
};

// The exception that every function of the libraries throws.
class Error : public std::runtime_error {
 public:
  // One line, as a user reads it.
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }                   // whose fault it is
  int exit_code() const { return static_cast<int>(kind_); }  // its number

  // throw input_error("{}: light {}: radius is NaN", …).about("radius"): the setting, option or field of a
  // file that is wrong, by its name there. A message that begins with that name, or "set" and it, needs none.
  Error&& about(std::string field) && {
    field_ = std::move(field);
    return std::move(*this);
  }
  const std::string& field() const { return field_; }  // empty: not told

 private:
  ErrorKind kind_;
  std::string field_;
};

// throw input_error("{}: light {} \"{}\": radius is NaN", path, i, name);
template <typename... Args>
Error input_error(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorKind::input, fmt::format(format, std::forward<Args>(args)...)};
}

// The same for what this machine cannot do.
template <typename... Args>
Error machine_error(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorKind::machine, fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace lightgrid
