#include "base/compiling.h"

#include <mutex>
#include <utility>

namespace lightgrid {
namespace {

struct Listener {
  std::mutex mutex;
  FirstCompilationFunction function;
  int kernels = 0;
};

Listener& listener() {
  static Listener* const shared = new Listener;  // outlives every thread
  return *shared;
}

}  // namespace

void set_first_compilation_function(FirstCompilationFunction function) {
  const std::lock_guard lock(listener().mutex);
  listener().function = std::move(function);
}

FirstCompilation::FirstCompilation() {
  const std::lock_guard lock(listener().mutex);
  ++listener().kernels;
  if (listener().function) listener().function(listener().kernels);
}

FirstCompilation::~FirstCompilation() {
  const std::lock_guard lock(listener().mutex);
  if (listener().function) listener().function(0);
}

}  // namespace lightgrid
