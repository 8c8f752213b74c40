// Depth bounds against a plain read of the same bytes, on the OpenCL device that lightgrid would use.
//   depth_read [WIDTHxHEIGHT] [RUNS]
// Prints one line: bytes, then least and median milliseconds on the device of the plain read and of depth
// bounds. Both run in turn, on the same buffer, in the cache if it fits.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "base/error.h"
#include "base/timer.h"
#include "cl/launch.h"
#include "culling/light_culler.h"
#include "scene/camera.h"

namespace lightgrid {
namespace {

constexpr int group_items = 64;

// One item (CPU) or one group (GPU) for each `span` values, as many as a tile has; the sum prevents removal
// of the reads.
constexpr const char* plain_read = R"(
kernel void plain_read(global const uint* values, uint count, uint span, global uint* sums) {
#ifdef GROUP
  const uint begin = get_group_id(0) * span, end = min(begin + span, count);
  uint sum = 0;
  for (uint i = begin + get_local_id(0); i < end; i += GROUP) sum += values[i];
  sums[get_global_id(0)] = sum;
#else
  const uint begin = get_global_id(0) * span, end = min(begin + span, count);
  uint16 sum = 0;
  uint i = begin;
  for (; i + 16 <= end; i += 16) sum += vload16(0, values + i);
  for (; i < end; ++i) sum.s0 += values[i];
  const uint8 a = sum.lo + sum.hi;
  const uint4 b = a.lo + a.hi;
  sums[get_global_id(0)] = b.x + b.y + b.z + b.w;
#endif
}
)";

double last_ms(ClDevice& device) { return device.profiler().collect().front().ms; }

void measure(int width, int height, int runs) {
  constexpr int tile = 16;
  ClDevice device;
  ProgramCache programs(device);
  const bool cpu = device.info().cpu;
  const cl_uint count = cl_uint(width) * height, span = tile * tile;
  const size_t spans = (count + span - 1) / span, items = cpu ? 1 : group_items;

  std::vector<float> depth(count);
  for (cl_uint i = 0; i < count; ++i) depth[i] = 0.01f + 0.5f * float(i % 97) / 97;
  cl::Buffer values(device.context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, depth.size() * 4,
                    depth.data());
  cl::Buffer sums(device.context(), CL_MEM_READ_WRITE, spans * items * 4);
  cl::Kernel read =
      programs.kernel_of_source("plain_read", plain_read, cpu ? "" : fmt::format("-DGROUP={}", group_items));
  LightCuller culler(device, programs, {.tile = tile});
  const View view = make_view(look_at({0, 0, 0}, {0, 0, -1}), width, height);
  culler.set_view({view.width, view.height, view.clip_from_view, view.view_from_world, view.eye, {}});

  device.profiler().time_launches(true);
  std::vector<double> read_ms, bounds_ms;
  for (int i = -3; i < runs; ++i) {
    launch(device, "plain_read", read, spans * items, items, values, count, span, sums);
    const double one = last_ms(device);
    culler.depth_bounds({values});
    const double other = last_ms(device);
    if (i >= 0) {
      read_ms.push_back(one);
      bounds_ms.push_back(other);
    }
  }
  const Spread a = spread_of(read_ms), b = spread_of(bounds_ms);
  fmt::print("{} {} {} {} {}\n", size_t(count) * 4, a.min, a.median, b.min, b.median);
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) {
  int width = 1280, height = 720, runs = 100;
  if (argc > 1 && (std::sscanf(argv[1], "%dx%d", &width, &height) != 2 || width < 1 || height < 1)) return 2;
  if (argc > 2 && (runs = std::atoi(argv[2])) < 1) return 2;
  try {
    lightgrid::measure(width, height, runs);
  } catch (const lightgrid::Error& error) {
    std::fprintf(stderr, "depth_read: %s\n", error.what());
    return error.exit_code();
  }
}
