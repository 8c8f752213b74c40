// Spots with equal angles, which have a hard edge, and of 90 degrees: every technique draws forward's
// picture. RayCaster.ForwardHasItsRadianceUnderSpotsWithHardEdges says that forward's is right.
#include <numbers>

#include "accuracy/oracle_sample.h"
#include "oracle/position.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "shared/cull_tests.h"
#include "support/small_scene.h"
#include "techniques/lidr_scenes.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr float right_angle = std::numbers::pi_v<float> / 2;

SmallScene scene_with_edges() {
  SmallScene s = small_scene();
  s.scene.lights.clear();
  for (const auto& [inner, outer] : {std::pair(0.03f, 0.03f),
                                     {0.2f, 0.2f},
                                     {0.5f, 0.5f},
                                     {0.1f, right_angle},
                                     {right_angle, right_angle}}) {
    Light& light =
        add_spot(s.scene, "torch", {0, 0, -1}, {-0.5f + outer, 0, -4}, {1, 0.8f, 0.6f}, 9, 5, 10, 25);
    light.inner_cone_rad = inner;
    light.outer_cone_rad = outer;
  }
  return s;
}

struct ConeEdges : testing::TestWithParam<const Technique*> {};

TEST_P(ConeEdges, AreForwards) {
  const SmallScene s = scene_with_edges();
  const View view = small_view(61, 41);
  const Image forward = render(s.scene, view, "forward");
  const Image image = render(s.scene, view, GetParam()->name);
  for (const glm::vec4& pixel : image.pixels) ASSERT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b));
  if (!GetParam()->approximate) expect_close(s.scene, view, {}, forward, GetParam()->name, other_order);
}

INSTANTIATE_TEST_SUITE_P(Techniques, ConeEdges, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

// In every cull test the lists leave out only zeros.
TEST(ConeEdges, AreInTheListsOfEveryCullTest) {
  const SmallScene s = scene_with_edges();
  const View view = small_view(61, 41);
  const Image forward = render(s.scene, view, "forward");
  for (const CullTestRow& row : cull_tests) {
    Settings settings;
    settings.set(setting::cull_test, row.test);
    settings.set(setting::tile, 8);
    EXPECT_TRUE(same_bytes(render(s.scene, view, "forward_plus", settings), forward)) << row.name;
  }
}

// A pixel whose centre lies on an edge, up to rounding, is compared with nothing.
TEST(ConeEdges, AreWhereTheOracleDoesNotDecide) {
  SmallScene s = scene_with_edges();
  const View view = small_view(61, 41);
  TechniqueRun run(test_devices(), s.scene, view, {}, find_technique("forward"));
  run.run_frame();
  const std::vector<float> depth = read_depth(run);
  const std::vector<uint32_t> pixels = covered_pixels(depth);
  const uint32_t pixel = pixels[pixels.size() / 2];
  const auto at = position_from_depth(view, int(pixel) % 61, int(pixel) / 61, depth[pixel]);
  EXPECT_EQ(SurfaceOracle(run.view(), depth).decided(pixels).size(), pixels.size());
  const glm::dvec3 world = glm::inverse(view.view_from_world) * glm::dvec4(at, 1);
  Light& edge = s.scene.lights[1];
  edge.inner_cone_rad = edge.outer_cone_rad = float(
      std::acos(glm::dot(glm::normalize(world - edge.position), glm::normalize(glm::dvec3(edge.direction)))));
  TechniqueRun again(test_devices(), s.scene, view, {}, find_technique("forward"));
  again.run_frame();
  const std::vector<uint32_t> decided = SurfaceOracle(again.view(), depth).decided(pixels);
  EXPECT_TRUE(std::ranges::find(decided, pixel) == decided.end());
  EXPECT_GT(decided.size(), pixels.size() - 10);
}

}  // namespace
}  // namespace lightgrid
