// Which z-bins each light may reach, on cases solved by hand; agreement/z_bins_of_lights
// (src/laboratory/verify) has the rest.
#include <gmock/gmock.h>

#include "base/error.h"
#include "culling/culled_grid.h"
#include "shared/slices.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

std::vector<uint32_t> bins_of(const std::vector<CullLight>& lights, const View& view,
                              const std::vector<float>& edges, KernelShape shape = KernelShape::automatic) {
  LightCuller culler(test_device(), test_programs(), {.shape = shape});
  culler.set_lights(lights);
  CullView culled = cull_view_of(view);
  culled.z_bin_edges = edges;
  culler.set_view(culled);
  ClGridStorage storage(test_device());
  const std::vector<DepthInterval> everywhere(tile_count(view, 16), {1, 9});
  return read_grid(test_device(), culler.cull(culler.bounds_of(everywhere), storage), storage).z_bins;
}

// The bins of one light at a distance straight ahead.
std::vector<uint32_t> bins_at(double distance_m, double radius_m, const View& view) {
  const std::vector<float> edges = {1, 2, 4};
  const std::vector<uint32_t> words = bins_of({{{0, 0, -distance_m}, radius_m}}, view, edges);
  std::vector<uint32_t> held;
  for (uint32_t bin = 0; bin <= edges.size(); ++bin) {
    if (bins_hold(words.at(0), bin)) held.push_back(bin);
  }
  return held;
}

TEST(ZBins, HoldALightWhereItReaches) {
  using testing::ElementsAre, testing::IsEmpty;
  const View view = view_of(64, 48, 60);
  EXPECT_THAT(bins_at(3, 0.5, view), ElementsAre(2));
  EXPECT_THAT(bins_at(3, 1.5, view), ElementsAre(1, 2, 3));
  EXPECT_THAT(bins_at(3, 1, view), ElementsAre(1, 2, 3)) << "tangent to two edges";
  EXPECT_THAT(bins_at(2, 0, view), ElementsAre(1, 2)) << "a point on an edge";
  EXPECT_THAT(bins_at(0, 0.5, view), ElementsAre(0)) << "around the eye";
  EXPECT_THAT(bins_at(-1, 0.5, view), IsEmpty()) << "behind it";
  EXPECT_THAT(bins_at(-1, 2.5, view), ElementsAre(0, 1)) << "behind it, and reaching past it";
  EXPECT_THAT(bins_at(1e6, 1, view), ElementsAre(3)) << "past the last edge";
  EXPECT_THAT(bins_at(3, no_end, view), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(bins_at(3, 1e20, view), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(bins_at(3, -1, view), IsEmpty()) << "no light";
  const View box = orthographic_view_of(64, 48, 2, -5, 10);
  EXPECT_THAT(bins_at(-3, 0.5, box), ElementsAre(0)) << "a box reaches behind the eye";
}

TEST(ZBins, AreTheSameInBothShapesAndOfAnyNumberOfLights) {
  const View view = view_of(64, 48, 60);
  for (const int count : {0, 1, 63, 64, 65, 300}) {
    std::vector<CullLight> lights;
    for (int i = 0; i < count; ++i) lights.push_back({{0, 0, -0.1 * i}, 0.03 * (i % 40)});
    const auto bins = bins_of(lights, view, {1, 2, 4, 8}, KernelShape::lanes);
    EXPECT_EQ(bins.size(), lights.size());
    EXPECT_EQ(bins, bins_of(lights, view, {1, 2, 4, 8}, KernelShape::group));
  }
  EXPECT_TRUE(bins_of({{{0, 0, -1}, 1}}, view, {}).empty()) << "a view without edges has no bins";
}

TEST(ZBins, OfEdgesThatMakeNoneAreRefused) {
  const View view = view_of(64, 48, 60);
  for (const std::vector<float>& edges :
       {std::vector<float>{2, 1}, {0, 1}, {1, INFINITY}, {1, NAN}, std::vector<float>(256, 1.0f)}) {
    EXPECT_THAT(error_of([&] {
                  bins_of({{{0, 0, -1}, 1}}, view, edges);
                }),
                testing::HasSubstr("z_bin_edges"));
  }
  EXPECT_EQ(bins_of({{{0, 0, -1}, 1}}, view, std::vector<float>(255, 1.0f)).size(), 1u);
}

TEST(ZBins, OfAKeyAreThatManyEdgesReached) {
  std::vector<float> edges(MOST_Z_BINS, INFINITY);
  for (int i = 0; i < 255; ++i) edges[i] = float(i) - 100;
  EXPECT_EQ(z_bin_of_key(-INFINITY, edges.data()), 0u);
  EXPECT_EQ(z_bin_of_key(std::nextafter(-100.0f, -INFINITY), edges.data()), 0u);
  EXPECT_EQ(z_bin_of_key(NAN, edges.data()), 0u);
  for (int i = 0; i < 255; ++i) {
    EXPECT_EQ(z_bin_of_key(edges[i], edges.data()), uint(i + 1));
    EXPECT_EQ(z_bin_of_key(edges[i] + 0.5f, edges.data()), uint(i + 1));
  }
  EXPECT_EQ(z_bin_of_key(1e30f, edges.data()), 255u);
}

}  // namespace
}  // namespace lightgrid
