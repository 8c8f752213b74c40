// Ends of the program that main does not choose.
#pragma once

#include <filesystem>
#include <string_view>

namespace lightgrid::app {

// While it exists, a driver that ends the process does so with status 3 and a line that says why: LLVM calls
// exit(1) and PoCL abort() if the disk under PoCL's cache is full; without memory they also throw in threads
// of their own, or crash. A signal keeps its effect if there is room on the disk and memory. main creates
// one, before other threads start.
class SuddenEnds {
 public:
  explicit SuddenEnds(const std::filesystem::path& cache);
  ~SuddenEnds();
  SuddenEnds(const SuddenEnds&) = delete;
  SuddenEnds& operator=(const SuddenEnds&) = delete;
};

inline constexpr std::string_view out_of_memory_line =
    "lightgrid: out of memory; a smaller --size, scene or number of lights would help\n";

}  // namespace lightgrid::app
