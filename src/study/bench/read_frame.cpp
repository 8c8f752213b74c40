#include "study/bench/read_frame.h"

#include "study/frame_file.h"

namespace lightgrid {

BenchFrame read_bench_frame(const std::filesystem::path& folder) {
  CapturedFrame frame = read_frame(folder);
  return {frame.name, frame.view, local_world_lights(frame), std::move(frame.depth)};
}

}  // namespace lightgrid
