// The standard frames of `lightgrid bench`, compared with a plain count of the lights that their tiles list.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/standard_frames.h"

namespace lightgrid::lab {
namespace {

struct Tile {
  double near = 1e9, far = 0;
};

// Distances back from reversed depth, reduced to tiles of 16 pixels.
std::vector<Tile> tiles_of(const CapturedFrame& frame) {
  const int across = (frame.view.width + 15) / 16, up = (frame.view.height + 15) / 16;
  std::vector<Tile> tiles(size_t(across) * up);
  const double a = frame.view.clip_from_view[2][2], b = frame.view.clip_from_view[3][2];
  for (int y = 0; y < frame.view.height; ++y) {
    for (int x = 0; x < frame.view.width; ++x) {
      const double distance = b / (double(frame.depth[size_t(y) * frame.view.width + x]) + a);
      Tile& tile = tiles[size_t(y / 16) * across + x / 16];
      tile.near = std::min(tile.near, distance);
      tile.far = std::max(tile.far, distance);
    }
  }
  return tiles;
}

// Four side planes of a tile and its interval, in double, for each light and each tile.
double mean_listed(const CapturedFrame& frame) {
  const int across = (frame.view.width + 15) / 16;
  const std::vector<Tile> tiles = tiles_of(frame);
  const auto inside = [&](int axis, int tile, int pixels, const Light& light) {
    const double d = -light.position.z, v = light.position[axis],
                 scale = frame.view.clip_from_view[axis][axis];
    const double low = (tile * 32.0 / pixels - 1) / scale, high = ((tile + 1) * 32.0 / pixels - 1) / scale;
    return (v - low * d) / std::hypot(1, low) >= -light.radius_m &&
           (high * d - v) / std::hypot(1, high) >= -light.radius_m;
  };
  size_t listed = 0;
  for (size_t t = 0; t < tiles.size(); ++t) {
    for (const Light& light : frame.lights) {
      const double d = -light.position.z;
      listed += d + light.radius_m >= tiles[t].near && d - light.radius_m <= tiles[t].far &&
                inside(0, int(t % across), frame.view.width, light) &&
                inside(1, int(t / across), frame.view.height, light);
    }
  }
  return double(listed) / double(tiles.size());
}

TEST(StandardFrames, ListAsManyLightsAsWanted) {
  EXPECT_NEAR(mean_listed(make_standard_frame({.lights = 256})), 32, 0.3);
  EXPECT_NEAR(mean_listed(make_standard_frame({.spheres = true, .lights = 300, .mean_listed = 20})), 20, 0.3);
  EXPECT_NEAR(mean_listed(make_standard_frame({.lights = 10})), 5, 0.3) << "half the lights at most";
}

TEST(StandardFrames, AreTheSameEachTimeAndShowSurfacesOnly) {
  const FrameRecipe recipe{.lights = 20, .width = 321, .height = 181};
  const CapturedFrame a = make_standard_frame(recipe), b = make_standard_frame(recipe);
  EXPECT_EQ(a.depth, b.depth);
  ASSERT_EQ(a.lights.size(), 20u);
  for (size_t i = 0; i < a.lights.size(); ++i) EXPECT_EQ(a.lights[i].position, b.lights[i].position);
  ASSERT_EQ(a.depth.size(), 321u * 181);
  EXPECT_GT(*std::min_element(a.depth.begin(), a.depth.end()), 0.0f);
  EXPECT_LT(*std::max_element(a.depth.begin(), a.depth.end()), 1.0f);
}

TEST(StandardFrames, KeepTheirLightsAtEverySize) {
  const CapturedFrame small = make_standard_frame({.lights = 50, .width = 64, .height = 36});
  const CapturedFrame large = make_standard_frame({.lights = 50});
  for (size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(small.lights[i].position, large.lights[i].position);
    EXPECT_EQ(small.lights[i].radius_m, large.lights[i].radius_m);
  }
}

TEST(StandardCases, HaveNamesOfTheirOwn) {
  std::vector<std::string> names;
  for (const BenchCase& c : standard_cases()) names.push_back(c.name);
  for (const char* name :
       {"floor-256", "floor-1024", "floor-4096", "floor-65536", "spheres-1024", "floor-1000000", "lights-1",
        "lights-1000000", "tile-8", "tile-64", "size-640x360", "size-7680x4320"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

}  // namespace
}  // namespace lightgrid::lab
