// Tiles cut into slices of distance: clusters.
#include <algorithm>

#include <gmock/gmock.h>

#include "culling/cell_truth.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

HostGrid cull_sliced(const View& view, const std::vector<ViewLight>& lights,
                     const std::vector<DepthInterval>& intervals, const std::vector<float>& edges,
                     KernelShape shape, CullParams* params = nullptr) {
  LightCuller culler(test_device(), test_programs(), {.shape = shape});
  culler.set_lights(cull_lights_of(lights));
  CullView cull_view = cull_view_of(view);
  cull_view.slice_edges = edges;
  culler.set_view(cull_view);
  if (params) *params = culler.params();
  ClGridStorage storage(test_device());
  return read_grid(test_device(), culler.cull(culler.bounds_of(intervals), storage), storage);
}

struct Sliced : testing::TestWithParam<KernelShape> {
  View view = view_of(127, 73, 60);
  std::vector<ViewLight> lights;
  std::vector<DepthInterval> intervals;

  void SetUp() override {
    Random random(3);
    for (int i = 0; i < 400; ++i) {
      const double d = 0.2 * std::exp2(8 * random.uniform());
      const glm::dvec3 place(d * random.uniform(-1, 1), d * random.uniform(-0.6f, 0.6f), -d);
      lights.push_back(point_light(place, 0.3 * d * random.uniform()));
    }
    for (size_t i = 0; i < tile_count(view, 16); ++i) {
      const float near = 0.2f + 10 * random.uniform();
      intervals.push_back({near, near + 20 * random.uniform()});
    }
  }
};

TEST_P(Sliced, CellsListWhatTouchesThemAndNothingOfOtherTiles) {
  const std::vector<float> edges = slice_edges(SliceSpacing::exponential, 8, 0.1, 50);
  CulledGrid sliced;
  const HostGrid host = cull_sliced(view, lights, intervals, edges, GetParam(), &sliced.params);
  ASSERT_EQ(host.slices, 8);
  ASSERT_EQ(host.cells.size(), 8 * intervals.size());
  const HostGrid whole = cull_sliced(view, lights, intervals, {}, GetParam());
  sliced.indices = host.indices;
  uint64_t touching = 0;
  for (int s = 0; s < 8; ++s) {
    std::vector<glm::vec2> cut;
    for (const DepthInterval& i : intervals) {
      cut.emplace_back(s > 0 ? std::max(i.near, edges[s - 1]) : i.near,
                       s < 7 ? std::min(i.far, edges[s]) : i.far);
    }
    sliced.cells.assign(host.cells.begin() + s * intervals.size(),
                        host.cells.begin() + (s + 1) * intervals.size());
    touching += expect_none_lost(view, lights, cut, sliced, 0.5);
    for (size_t i = 0; i < intervals.size(); ++i) {
      const auto list = sliced.list(i);
      const auto first = whole.indices.begin() + whole.cells[i].x;
      EXPECT_TRUE(std::includes(first, first + whole.cells[i].y, list.begin(), list.end()))
          << "slice " << s << " tile " << i;
    }
  }
  EXPECT_GT(touching, 500u);
  EXPECT_LT(host.indices.size(), whole.indices.size() * 4);  // most lights touch few slices
}

INSTANTIATE_TEST_SUITE_P(Shapes, Sliced, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "lanes" : "group";
                         });

TEST(Slices, GiveTheSameBytesInBothShapes) {
  const View view = view_of(127, 73, 60);
  std::vector<ViewLight> lights;
  for (int i = 0; i < 100; ++i)
    lights.push_back(point_light({0.1 * (i % 10) - 0.5, 0, -1 - 0.2 * i}, 0.05 * i));
  const std::vector<DepthInterval> intervals(tile_count(view, 16), {0.5f, 30});
  const std::vector<float> edges = slice_edges(SliceSpacing::linear, 5, 0.1, 20);
  EXPECT_TRUE(cull_sliced(view, lights, intervals, edges, KernelShape::lanes) ==
              cull_sliced(view, lights, intervals, edges, KernelShape::group));
}

}  // namespace
}  // namespace lightgrid
