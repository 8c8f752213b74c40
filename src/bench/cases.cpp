#include "bench/cases.h"

#include <fmt/format.h>

namespace lightgrid {

std::vector<BenchCase> standard_cases() {
  std::vector<BenchCase> cases;
  for (const int lights : {256, 1024, 4096, 65536}) {
    cases.push_back({fmt::format("floor-{}", lights), {.lights = lights}});
  }
  cases.push_back({"spheres-1024", {.spheres = true, .lights = 1024}});
  cases.push_back({"floor-1000000", {.lights = 1'000'000, .mean_listed = 10}});
  for (int lights = 1; lights <= 1'000'000; lights *= 10) {
    cases.push_back({fmt::format("lights-{}", lights),
                     {.lights = lights, .mean_listed = lights < 1'000'000 ? 32.0 : 10.0}});
  }
  for (const int tile : {8, 16, 32, 64}) {
    cases.push_back({fmt::format("tile-{}", tile), {.lights = 4096}, {}, tile});
  }
  constexpr int sizes[][2] = {{640, 360},   {1280, 720},  {1920, 1080},
                              {2560, 1440}, {3840, 2160}, {7680, 4320}};
  for (const auto& [width, height] : sizes) {
    cases.push_back(
        {fmt::format("size-{}x{}", width, height), {.lights = 4096, .width = width, .height = height}});
  }
  for (const char* scene : {"hall", "terrain"}) {
    cases.push_back({fmt::format("raster-{}", scene), {.width = 1280, .height = 720}, {}, 0, scene});
  }
  return cases;
}

}  // namespace lightgrid
