// A captured frame from its folder.
#pragma once

#include <filesystem>

#include "study/bench/frame.h"

namespace lightgrid {

// As read_frame (study/frame_file.h) reads it, without its directional lights.
BenchFrame read_bench_frame(const std::filesystem::path& folder);

}  // namespace lightgrid
