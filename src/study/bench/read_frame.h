// A captured frame from its folder.
#pragma once

#include <filesystem>

#include "study/bench/frame.h"

namespace lightgrid {

// view.json, lights.json and depth.f32 of the folder. Throws Error(input) that names the file and the field.
BenchFrame read_bench_frame(const std::filesystem::path& folder);

}  // namespace lightgrid
