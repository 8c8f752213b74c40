// The error that a call throws, for tests of messages.
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "base/error.h"

namespace lightgrid {

// The message of the Error that `call` throws, which must be of this kind; "no error" if it throws none.
std::string error_of(auto&& call, ErrorKind kind = ErrorKind::input) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(int(error.kind()), int(kind)) << error.what();
    return error.what();
  }
  return "no error";
}

}  // namespace lightgrid
