// Errors and notices of one line, for tests.
#pragma once

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "base/error.h"

namespace lightgrid::lab {

struct Told {
  std::vector<std::string> lines;
  std::function<void(const std::string&)> notice() {
    return [this](const std::string& line) { lines.push_back(line); };
  }
};

// The message of the Error that `call` throws.
template <typename Call>
std::string fault_of(Call call, ErrorKind kind = ErrorKind::input) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

}  // namespace lightgrid::lab
