#include "base/compiling.h"

#include <mutex>
#include <utility>

namespace lightgrid {
namespace {

struct Listener {
  std::mutex mutex;
  FirstCompilationFunction function;
  int begun = 0, total = 0, left = 0;  // kernels
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
  ++listener().total;
  ++listener().left;
}

void FirstCompilation::begin() {
  const std::lock_guard lock(listener().mutex);
  begun_ = true;
  ++listener().begun;
  if (listener().function) listener().function(listener().begun, listener().total);
}

FirstCompilation::~FirstCompilation() {
  const std::lock_guard lock(listener().mutex);
  if (!begun_) --listener().total;
  if (--listener().left == 0 && listener().function) listener().function(0, 0);
}

}  // namespace lightgrid
