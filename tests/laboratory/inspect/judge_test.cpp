// `cull --judge`: planted losses are found, with their pixels, and none is invented.
#include "inspect/judge.h"

#include <gmock/gmock.h>

#include <map>
#include <random>

#include "frames/captured_frame.h"
#include "frames/frame_lists.h"
#include "oracle/position.h"
#include "support/render.h"

namespace lightgrid::lab {
namespace {

FrameGrid grid_of(const CapturedFrame& frame) {
  FrameCuller culler(*software_devices().cl, *software_devices().kernels, frame, {});
  culler.run();
  return culler.grid();
}

void take_out(FrameGrid& grid, size_t cell, uint32_t light) {
  const glm::uvec2 list = grid.lists.cells[cell];
  const auto first = grid.lists.indices.begin() + list.x, end = first + list.y;
  const auto found = std::find(first, end, light);
  ASSERT_NE(found, end);
  std::copy(found + 1, end, found);
  --grid.lists.cells[cell].y;
}

// In the frame, of a light in lists.
int number_of(const CapturedFrame& frame, uint32_t light) {
  int number = 0;
  for (;; ++number)
    if (!is_directional(frame.lights[size_t(number)]) && light-- == 0) return number;
}

// The pixels of the tile whose surface the light reaches, one by one.
std::vector<PicturePixel> lit_in(const CapturedFrame& frame, const FrameGrid& grid, size_t cell,
                                 uint32_t light) {
  const ViewLight of = local_lights(frame)[light];
  const int x0 = int(cell) % grid.lists.cells_x * grid.tile, y0 = int(cell) / grid.lists.cells_x * grid.tile;
  std::vector<PicturePixel> lit;
  for (int y = std::min(y0 + grid.tile, frame.view.height) - 1; y >= y0; --y)
    for (int x = x0; x < std::min(x0 + grid.tile, frame.view.width); ++x)
      if (is_covered(frame, x, y) &&
          is_lit(of, position_from_depth(frame.view, x, y, frame.depth[frame.view.grid().index(x, y)])))
        lit.push_back({x, flipped_row(y, frame.view.height)});
  return lit;
}

TEST(Judge, InventsNoLoss) {
  for (const CapturedFrame& frame : {small_frame(149, 83), with_standard_depth(small_frame(149, 83), 40)}) {
    const Judgement j = judge(frame, grid_of(frame));
    EXPECT_EQ(j.maps.pairs.lost, 0u);
    EXPECT_THAT(j.lost, testing::IsEmpty());
    EXPECT_GT(j.maps.pairs.lit, 1000u);
  }
}

TEST(Judge, FindsEachPlantedLoss) {
  const CapturedFrame frame = small_frame(149, 83);
  const FrameGrid whole = grid_of(frame);
  std::mt19937 random(1);
  int planted = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const size_t cell = random() % whole.lists.cells.size();
    const glm::uvec2 list = whole.lists.cells[cell];
    if (list.y == 0) continue;
    const uint32_t light = whole.lists.indices[list.x + random() % list.y];
    FrameGrid grid = whole;
    take_out(grid, cell, light);
    const std::vector<PicturePixel> lit = lit_in(frame, whole, cell, light);
    const Judgement j = judge(frame, grid);
    EXPECT_EQ(j.maps.pairs.lost, lit.size());
    ASSERT_EQ(j.lost.size(), lit.empty() ? 0u : 1u);
    if (lit.empty()) continue;
    ++planted;
    EXPECT_EQ(j.lost[0].light, number_of(frame, light));
    EXPECT_EQ(j.lost[0].pixels, lit.size());
    EXPECT_EQ(j.lost[0].first, lit[0]);
    EXPECT_GT(j.lost[0].inside_m, 0);
    const auto lossy = std::ranges::find_if(j.cells, [](const CellPairs& c) { return c.lost > 0; });
    ASSERT_NE(lossy, j.cells.end());
    EXPECT_EQ(lossy->cell, cell);
    EXPECT_EQ(lossy->lost, lit.size());
  }
  EXPECT_GT(planted, 50);
}

// The same lists, read through a number for each pixel.
TEST(Judge, ReadsCellsThatAreNoTiles) {
  const CapturedFrame frame = small_frame(149, 83);
  FrameGrid tiles = grid_of(frame);
  const ListedLights lists = listed_lights(frame, tiles);
  take_out(tiles, 8, tiles.lists.indices[tiles.lists.cells[8].x]);
  FrameGrid pixels = tiles;
  pixels.cell_of_pixel = lists.cell_of_pixel;
  EXPECT_EQ(judgement_json(frame, tiles, judge(frame, tiles)),
            judgement_json(frame, pixels, judge(frame, pixels)));
  // A pixel without a cell lists nothing.
  const Judgement before = judge(frame, pixels);
  uint32_t some = 0;
  while (before.maps.listed[some] == 0 || before.maps.lost[some] > 0) ++some;
  pixels.cell_of_pixel[some] = no_cell;
  const Judgement without = judge(frame, pixels);
  EXPECT_EQ(without.maps.pairs.listed, before.maps.pairs.listed - before.maps.listed[some]);
  EXPECT_EQ(without.maps.pairs.lost,
            before.maps.pairs.lost + before.maps.listed[some] - before.maps.false_positives[some]);
}

TEST(Judge, WritesATestCaseForEachLight) {
  const CapturedFrame frame = small_frame(149, 83);
  FrameGrid grid = grid_of(frame);
  for (glm::uvec2& cell : grid.lists.cells) cell.y = 0;
  const Judgement j = judge(frame, grid);
  const std::string junit = judgement_junit(frame, j);
  size_t cases = 0, failures = 0;
  for (size_t at = 0; (at = junit.find("<testcase", at)) != junit.npos; ++at) ++cases;
  for (size_t at = 0; (at = junit.find("<failure", at)) != junit.npos; ++at) ++failures;
  EXPECT_EQ(cases, frame.lights.size());
  EXPECT_EQ(failures, j.lost.size());
  EXPECT_GT(failures, 10u);
}

}  // namespace
}  // namespace lightgrid::lab
