// The frame of every function of lightgrid.h: exceptions become a status and this thread's last
// error.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "c_api/lightgrid.h"

namespace lightgrid::app::c {

// Thrown by a progress function's wish. No Error: a comparison records those as refusals and goes on.
struct Cancelled {};

// Records the exception that is being handled.
lightgrid_status failed() noexcept;

// The warnings of this thread's last call, for lightgrid_describe.
std::vector<Warning>& last_warnings();

// Makes what is warned of while it exists the last call's.
class CallWarnings {
 public:
  ~CallWarnings() { last_warnings() = collector_.warnings(); }

 private:
  WarningCollector collector_;
};

template <typename Work>
lightgrid_status call(const Work& work) noexcept {
  try {
    const CallWarnings warnings;
    work();
    return LIGHTGRID_OK;
  } catch (...) {
    return failed();
  }
}

// input_error(…) about an argument, by its name: "image.width: 0 is not 640".
template <typename... Args>
Error wrong(const std::string& argument, fmt::format_string<Args...> format, Args&&... args) {
  return input_error("{}: {}", argument, fmt::format(format, std::forward<Args>(args)...)).about(argument);
}

template <typename T>
T& needed(T* argument, const char* name) {
  if (!argument) throw wrong(name, "is null");
  return *argument;
}

// For the caller to free.
char* text_for_caller(const std::string& text);

// The strings of a null-terminated array; none for null.
std::vector<std::string> words_of(const char* const* words);

}  // namespace lightgrid::app::c
