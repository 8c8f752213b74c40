// Who is told before a kernel or a shader is compiled: a window that shows why its picture waits.
#pragma once

#include <functional>
#include <string>

namespace lightgrid {

// Receives the name of the source file. Empty: nobody. Called on the thread that compiles, in the middle of a
// pass.
inline std::function<void(const std::string& file)> before_compiling;

inline void tell_compiling(const std::string& file) {
  if (before_compiling) before_compiling(file);
}

}  // namespace lightgrid
