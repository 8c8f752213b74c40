// Explains why a row is faster than the reference: factors that rows of the same run isolate.
#pragma once

#include <optional>

#include "measures/results.h"

namespace lightgrid::lab {

// Times of the reference relative to the row's. The product of the factors that are known is the total.
struct Speedup {
  double total = 1;
  // Shorter lists, on rows that draw with the same passes otherwise. Empty: no such rows were timed.
  std::optional<double> lists;
  // OpenCL instead of OpenGL, between rows with equally long lists. Empty: no such rows were timed.
  std::optional<double> api;
  double other = 1;  // everything that no pair of rows isolates
  // The factor of shorter lists relative to kernels that go through every light. It differs from `lists` if
  // those were isolated in OpenGL, since kernels spend less time per light and pixel. Empty: not timed.
  std::optional<double> lists_in_opencl;
  // The row that isolates a factor, next to the reference or to the row itself. Null: the two themselves do.
  const RunResult* by = nullptr;
};

// Empty if the row or the reference was not timed.
std::optional<Speedup> speedup_of(const CompareReport& report, const RunResult& row);

// Returns whether no pass draws or shades in OpenGL.
bool draws_without_opengl(const RunResult& row);

// Returns whether the row draws with the passes of `every_light`, so that its other passes only build lists.
bool adds_only_lists(const RunResult& row, const RunResult& every_light);

// The name of a driver that draws without a graphics card ("llvmpipe"); empty for others.
std::string software_opengl(const std::string& gl_device);

}  // namespace lightgrid::lab
