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
// so far, with this one, and the number of those known to be needed. When none is left: 0 and 0. Calls come
// from the threads that compile and do not overlap.
using FirstCompilationFunction = std::function<void(int kernels, int total)>;
void set_first_compilation_function(FirstCompilationFunction function);  // empty: nobody

// A kernel that later starts of the program load from disk. Exists from when the kernel is known to be needed
// until it is compiled, or no longer needed.
class FirstCompilation {
 public:
  FirstCompilation();
  ~FirstCompilation();
  FirstCompilation(const FirstCompilation&) = delete;
  FirstCompilation& operator=(const FirstCompilation&) = delete;
  void begin();  // reports it

 private:
  bool begun_ = false;
};

}  // namespace lightgrid
