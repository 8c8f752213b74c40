#include "oracle/lit_set.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightgrid::lab {
namespace {

// A wall 10 m away, 24 x 16 pixels; the pixels of the left 8 columns show nothing.
struct Wall {
  View view;
  std::vector<float> depth;
  Wall() {
    Camera camera;
    camera.near_m = 1;
    view = make_view(camera, 24, 16);
    for (int i = 0; i < 24 * 16; ++i) depth.push_back(i % 24 < 8 ? 0.0f : 0.1f);
  }
};

ViewLight point_light(glm::dvec3 position, double radius) {
  ViewLight light;
  light.type = LightType::point;
  light.position = position;
  light.radius_m = radius;
  return light;
}

TEST(LitBlocks, AddUpToWhatEachPixelSays) {
  const Wall wall;
  std::vector<ViewLight> lights;
  for (int i = 0; i < 60; ++i) {
    lights.push_back(point_light({i % 10 - 5.0, i / 10 - 3.0, -9.5 - 0.02 * i}, 0.4 + 0.05 * i));
  }
  ListedLights lists{.first = {0, 20}, .count = {20, 30}};
  for (uint32_t i = 0; i < 50; ++i) lists.indices.push_back(i);
  const ListAccuracy got = measure_lists(find_lit_blocks(wall.view, wall.depth, lights), 16, lists);
  for (int i = 0; i < 24 * 16; ++i) lists.cell_of_pixel.push_back(i % 24 / 16);
  const LitPairs want = count_pairs(wall.view, wall.depth, lights, lists);
  EXPECT_EQ(got.listed, want.listed);
  EXPECT_EQ(got.lit, want.lit);
  EXPECT_EQ(got.lost, want.lost);
  EXPECT_GT(got.lost, 0u);
  EXPECT_LT(got.lost, got.lit);
}

// Three tiles of 8 x 16 pixels, the first empty. By hand: light 0 lights everything, light 1 nothing.
TEST(ListAccuracy, OfATileIsListedOverLit) {
  const Wall wall;
  const std::vector<ViewLight> lights{point_light({0, 0, -10}, 100), point_light({0, 0, 100}, 1)};
  const LitBlocks blocks = find_lit_blocks(wall.view, wall.depth, lights);
  //                         row 0: empty, right, listed but unlit; row 1: empty but listed, lost, right
  const ListedLights lists{.first = {0, 0, 0, 0, 1, 0}, .count = {0, 1, 2, 2, 1, 1}, .indices = {0, 1}};
  const ListAccuracy got = measure_lists(blocks, 8, lists);
  EXPECT_EQ(got.lit, 4u * 64);
  EXPECT_EQ(got.listed, 5u * 64);
  EXPECT_EQ(got.lost, 64u);
  EXPECT_EQ(got.perfect, 4u * 64);
  EXPECT_EQ(got.tiles_lit, 4u);
  EXPECT_EQ(got.tiles_unlit, 0u);
  EXPECT_EQ(got.worst, 2);
}

// One light on one pixel of a tile, another on none: the perfect list is 1 for 64 pixels.
TEST(ListAccuracy, CountsThePerfectListOverTheTilesPixels) {
  const Wall wall;
  const LitBlocks pixels = find_lit_blocks(wall.view, wall.depth, {point_light({0, 0, -10}, 100)});
  LitBlocks blocks = pixels;
  for (auto& lit : blocks.lit) lit.clear();
  blocks.lit[1] = {{0, 1}};
  const ListedLights lists{.first = {0, 0}, .count = {2, 1}, .indices = {0, 1}};
  const ListAccuracy got = measure_lists(blocks, 16, lists);
  EXPECT_EQ(got.perfect, 128u);  // the block on its left is empty, that above it is covered
  EXPECT_EQ(got.listed, 2u * 128 + 128);
  EXPECT_EQ(got.lit, 1u);
  EXPECT_EQ(got.worst, 256);
  EXPECT_EQ(got.p99, 256);
  EXPECT_EQ(got.tiles_lit, 1u);
  EXPECT_EQ(got.tiles_unlit, 1u);
}

}  // namespace
}  // namespace lightgrid::lab
