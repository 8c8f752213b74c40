// Listeners to compilation, for programs that show why a picture waits.
#pragma once

#include <functional>
#include <string>

namespace lightgrid {

// Receives the name of each kernel's or shader's source file before it is compiled. Called on the thread that
// compiles, in the middle of a pass. Empty: nobody.
inline std::function<void(const std::string& file)> before_compiling;

inline void tell_compiling(const std::string& file) {
  if (before_compiling) before_compiling(file);
}

// Before each kernel that the process compiles for its first time on this machine: the number of such kernels
// so far, with this one. After it: 0. Calls come from the thread that compiles and do not overlap.
using FirstCompilationFunction = std::function<void(int kernels)>;
void set_first_compilation_function(FirstCompilationFunction function);  // empty: nobody

// Exists while a kernel is compiled that later starts of the program load from disk.
class FirstCompilation {
 public:
  FirstCompilation();
  ~FirstCompilation();
  FirstCompilation(const FirstCompilation&) = delete;
  FirstCompilation& operator=(const FirstCompilation&) = delete;
};

}  // namespace lightgrid
