// Depth slices: the slice of a depth, and the required lists of its cells.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "culling/cell_truth.h"
#include "culling/constants.h"
#include "oracle/test_views.h"
#include "scene/random.h"
#include "shared/light_grid.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;

CullView sliced(const View& view, const std::vector<float>& edges) { return cull_view_of(view, edges); }

uint slice_of(const CullView& view, float depth) {
  return slice_of_key(depth_key(view, depth), slice_keys(view).data());
}

TEST(SliceCells, ByHand) {
  EXPECT_THAT(slice_edges(SliceSpacing::linear, 4, 1, 9), ElementsAre(3, 5, 7));
  EXPECT_THAT(slice_edges(SliceSpacing::exponential, 4, 1, 16), ElementsAre(2, 4, 8));
  EXPECT_THAT(slice_edges(SliceSpacing::exponential, 4, 0, 1000),
              ElementsAre(testing::FloatNear(5.6234f, 1e-3f), testing::FloatNear(31.6228f, 1e-3f),
                          testing::FloatNear(177.828f, 1e-3f)));
  EXPECT_THAT(slice_edges(SliceSpacing::exponential, 4, -9, -1), ElementsAre(-7, -5, -3));
  EXPECT_TRUE(slice_edges(SliceSpacing::exponential, 1, 1, 16).empty());
  // Near 1 and far infinite: depth is 1 / distance.
  const CullView view = sliced(perspective_view(8, 8, 1, 1, 1, infinity), {2, 4, 8});
  const std::vector<float> depths = {1, 0.75f, 0.5f, 0.3f, 0.25f, 0.2f, 0.125f, 0.1f, 1e-40f, 0};
  std::vector<uint> slices;
  for (const float depth : depths) slices.push_back(slice_of(view, depth));
  EXPECT_THAT(slices, ElementsAre(0, 0, 1, 1, 2, 2, 3, 3, 3, 3));
}

// Compared with a scan of the edges, at each of them, a unit in the last place to either side, and outside
// all.
TEST(SliceCells, AreThoseOfAPlainScan) {
  for (const View& view : {view_of(8, 8, 60), view_of(8, 8, 60, 0.1, 50),
                           orthographic_view_of(8, 8, 5, 0, 50), orthographic_view_of(8, 8, 5, -20, 50)}) {
    for (const int count : {1, 2, 3, 24, 63, 64}) {
      for (const SliceSpacing spacing : {SliceSpacing::exponential, SliceSpacing::linear}) {
        const CullView cut = sliced(view, slice_edges(spacing, count, view.near_m, 40));
        EXPECT_NO_THROW(check_view(cut, 16));
        const auto keys = slice_keys(cut);
        std::vector<float> asked = {-1, -1.5f, -0.0f, 0, 1, -1e-40f, 1e30f, -1e30f, NAN};
        for (int i = 0; i < count - 1; ++i) {
          for (const float end : {keys[i], infinity, -infinity})
            asked.push_back(std::nextafter(keys[i], end));
        }
        for (const float key : asked) {
          uint slice = 0;
          while (slice < uint(count - 1) && key >= keys[slice]) ++slice;
          ASSERT_EQ(slice_of_key(key, keys.data()), slice) << count << " slices, key " << key;
        }
      }
    }
  }
}

TEST(SliceCells, EdgesThatMakeNoneAreRefused) {
  const View view = view_of(8, 8, 60);
  for (const std::vector<float>& edges :
       {std::vector<float>{2, 1}, {0}, {-1, 1}, {NAN}, {1, infinity}, std::vector<float>(64, 1)}) {
    EXPECT_THROW(check_view(sliced(view, edges), 16), Error);
  }
}

std::vector<ViewLight> lights_about(const View& view, const std::vector<float>& edges, int count,
                                    uint64_t seed) {
  Random random(seed);
  std::vector<ViewLight> lights;
  for (int i = 0; i < count; ++i) {
    const double edge = edges[random.next() % edges.size()];
    const double radius = edge * std::exp2(-8 * random.uniform());
    // Tangent to an edge from either side, or anywhere about it.
    const int side = int(random.next() % 3) - 1;
    const double d = side ? edge + side * radius : edge * (0.5 + random.uniform()),
                 scale = view.orthographic ? 1 : d;
    const glm::dvec3 p(view_x_of_pixel(view, view.width * random.uniform()) * scale,
                       view_y_of_pixel(view, view.height * random.uniform()) * scale, -d);
    lights.push_back(i % 4 == 3
                         ? spot_light(p, {random.uniform(-1, 1), random.uniform(-1, 1), 0.5}, 2 * radius, 0.5)
                         : point_light(p, float(radius)));
  }
  return lights;
}

// One slice of a grid as a grid.
CulledGrid slice_of(const CulledGrid& grid, size_t tiles, int slice) {
  CulledGrid one = grid;
  one.cells.assign(grid.cells.begin() + slice * tiles, grid.cells.begin() + (slice + 1) * tiles);
  return one;
}

TEST(SliceCells, ListWhatCertainlyTouchesThemInBothShapes) {
  const std::vector<float> edges = {0.5f, 1, 1.25f, 2, 2, 8, 40};
  for (const View& view :
       {view_of(127, 73, 60), view_of(17, 9, 120), orthographic_view_of(127, 73, 5, 0, 100)}) {
    const auto lights = lights_about(view, edges, 2000, 3);
    const size_t tiles = tile_count(view, 16);
    Random random(4);
    std::vector<glm::vec2> intervals;
    for (size_t i = 0; i < tiles; ++i) {
      const float near = edges[random.next() % edges.size()];
      const std::vector<glm::vec2> kinds = {
          {0, far_away}, {near, near}, {0.1f, near}, {near, 3 * near}, {far_away, -far_away}};
      intervals.push_back(kinds[random.next() % kinds.size()]);
    }
    CullerOptions options;
    options.shape = KernelShape::lanes;
    const CulledGrid grid = cull_cells(view, lights, intervals, options, edges);
    ASSERT_EQ(grid.cells.size(), tiles * (edges.size() + 1));
    expect_well_formed(grid, lights.size());
    uint64_t touching = 0;
    for (size_t s = 0; s <= edges.size(); ++s) {
      SCOPED_TRACE(s);
      std::vector<glm::vec2> cut = intervals;
      for (glm::vec2& i : cut)
        i = {s ? std::max(i.x, edges[s - 1]) : i.x, s < edges.size() ? std::min(i.y, edges[s]) : i.y};
      // The kernels' slices are a little wider: cells that only touch in an edge may list something.
      CulledGrid one = slice_of(grid, tiles, int(s));
      for (size_t i = 0; i < tiles; ++i) {
        if (!(cut[i].x <= cut[i].y) && cut[i].x - cut[i].y < 1e-6f * cut[i].x) one.cells[i].y = 0;
      }
      touching += expect_none_lost(view, lights, cut, one, 0.5);
    }
    EXPECT_GT(touching, 200u);
    options.shape = KernelShape::group;
    EXPECT_EQ(cull_cells(view, lights, intervals, options, edges), grid);
    options.shape = KernelShape::lanes;
    options.portable = true;
    EXPECT_EQ(cull_cells(view, lights, intervals, options, edges), grid);
  }
}

// A tiny light on the surface, whose distance is rounded as in shading, or by a division with an error of 2.5
// units: it must be in the slice of the pixel's depth. Depths on slice edges and a unit to either side.
TEST(SliceCells, TheSliceOfADepthListsWhatTouchesTheSurfaceThere) {
  for (const View& view :
       {view_of(127, 73, 60), view_of(127, 73, 60, 0.1, 50), orthographic_view_of(127, 73, 5, 0, 50)}) {
    const auto edges = slice_edges(SliceSpacing::exponential, 24, view.near_m, 40);
    const CullView cut = sliced(view, edges);
    const ViewParams p = view_params(cut, 16);
    Random random(5);
    std::vector<ViewLight> lights;
    std::vector<uint32_t> cells;
    while (lights.size() < 4000) {
      const int x = int(random.next() % 127), y = int(random.next() % 73);
      const float key = slice_keys(cut)[random.next() % edges.size()];
      const float depth = -std::nextafter(key, std::array{key, infinity, -infinity}[random.next() % 3]);
      float d = view.orthographic ? (p.depth_b - depth) * p.depth_a : p.depth_b / (depth + p.depth_a);
      if (!view.orthographic) d *= 1 + float(int(random.next() % 3) - 1) * 1.5f * 0x1p-23f;
      const float scale = view.orthographic ? 1 : d;
      const glm::vec3 place((x + 0.5f) * p.slope_x_scale + p.slope_x_offset,
                            (y + 0.5f) * p.slope_y_scale + p.slope_y_offset, 1);
      lights.push_back(point_light({place.x * scale, place.y * scale, -d}, 1e-9f));
      cells.push_back(
          cell_in_slice(cell_of_pixel(x, y, 16, p.tiles_x), slice_of(cut, depth), p.tiles_x, p.tiles_y));
    }
    const CulledGrid grid =
        cull_cells(view, lights, std::vector<glm::vec2>(tile_count(view, 16), {0, far_away}), {}, edges);
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const std::vector<uint32_t> list = grid.list(cells[i]);
      ASSERT_TRUE(std::binary_search(list.begin(), list.end(), i)) << i << " at " << -lights[i].position.z;
    }
    EXPECT_LT(grid.indices.size(), 4 * lights.size()) << "each is in few cells";
  }
}

}  // namespace
}  // namespace lightgrid
