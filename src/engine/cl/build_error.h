// A kernel that a driver cannot build.
#pragma once

#include "base/error.h"

namespace lightgrid {

// Error(machine), so that callers can tell it from a fault of what they ran.
class KernelBuildError : public Error {
 public:
  explicit KernelBuildError(const std::string& message) : Error(ErrorKind::machine, message) {}
};

}  // namespace lightgrid
