// A device and objects made from it are for one thread at a time (docs/library.md): threads with a device
// each do not affect one another, and a culler may move from thread to thread.
#include <gtest/gtest.h>

#include <barrier>
#include <random>
#include <thread>

#include "culling/culled_grid.h"

namespace lightgrid {
namespace {

std::vector<CullLight> lights_of_seed(uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (random() / 4294967295.0);
  };
  std::vector<CullLight> lights(300);
  for (CullLight& light : lights) {
    light.position = {between(-9, 9), between(-5, 5), between(-20, -1)};
    light.radius_m = between(0.2, 3);
  }
  return lights;
}

HostGrid grid_of_seed(ClDevice& device, LightCuller& culler, uint32_t seed) {
  culler.set_lights(lights_of_seed(seed));
  constexpr int width = 320, height = 180;
  culler.set_view(cull_view_of(view_of(width, height, 60)));
  std::vector<float> depth(size_t(width) * height);
  for (size_t i = 0; i < depth.size(); ++i)
    depth[i] = float(0.1 / (2 + double((i * 7919 + seed) % 1000) / 100));
  const cl::Buffer values(device.context(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                          depth.size() * sizeof(float), depth.data());
  ClGridStorage storage(device);
  const LightGrid grid = culler.cull(culler.depth_bounds({values}).opaque, storage);
  return read_grid(device, grid, storage);
}

void expect_same_grid(const HostGrid& found, const HostGrid& expected) {
  EXPECT_GT(expected.indices.size(), 1000u) << "nearly nothing to differ in";
  EXPECT_EQ(found.cells, expected.cells);
  EXPECT_EQ(found.indices, expected.indices);
}

TEST(Threads, WithADeviceEachCullAtOnceWhatOneCullsAlone) {
  constexpr uint32_t count = 3, frames = 20;
  std::vector<std::vector<HostGrid>> found(count);
  std::barrier start(count);
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < count; ++t) {
    threads.emplace_back([&, t] {
      start.arrive_and_wait();
      ClDevice device;
      ProgramCache programs(device);
      LightCuller culler(device, programs, {});
      for (uint32_t frame = 0; frame < frames; ++frame)
        found[t].push_back(grid_of_seed(device, culler, t + count * frame));
    });
  }
  for (std::thread& thread : threads) thread.join();
  LightCuller alone(test_device(), test_programs(), {});
  for (uint32_t t = 0; t < count; ++t) {
    for (uint32_t frame = 0; frame < frames; ++frame) {
      SCOPED_TRACE(fmt::format("thread {} frame {}", t, frame));
      expect_same_grid(found[t].at(frame), grid_of_seed(test_device(), alone, t + count * frame));
    }
  }
}

TEST(Threads, ACullerGoesFromThreadToThread) {
  LightCuller culler(test_device(), test_programs(), {});
  const HostGrid expected = grid_of_seed(test_device(), culler, 5);
  HostGrid found;
  std::thread([&] { found = grid_of_seed(test_device(), culler, 6); }).join();
  EXPECT_NE(found.indices, expected.indices);
  std::thread([&] { found = grid_of_seed(test_device(), culler, 5); }).join();
  expect_same_grid(found, expected);
  expect_same_grid(grid_of_seed(test_device(), culler, 5), expected);
}

}  // namespace
}  // namespace lightgrid
