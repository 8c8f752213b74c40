// Every technique in the registry, including new ones, draws forward's picture.
#include "support/small_scene.h"
#include "techniques/lidr_scenes.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct EveryTechnique : testing::TestWithParam<const Technique*> {};

// Techniques that draw another picture by design have their own tests.
std::vector<const Technique*> exact_techniques() {
  std::vector<const Technique*> exact = techniques();
  std::erase_if(exact, [](const Technique* technique) { return technique->approximate; });
  return exact;
}

void expect_forwards_picture(const Scene& scene, const View& view, const Technique& technique) {
  const Image forward = render(scene, view, "forward");
  ASSERT_GT(brightest_channel(forward), 0.01f) << "a dark picture shows nothing";
  expect_close(scene, view, {}, forward, technique.name, other_order);
}

TEST_P(EveryTechnique, DrawsForwardsPictureOfABuiltinScene) {
  Scene scene = find_builtin_scene("hall")->make();
  if (GetParam()->limited_lists) scene.lights.resize(12);  // within the capacity of every pixel
  expect_forwards_picture(scene, default_view(scene, 79, 45), *GetParam());
}

// Point, spot and directional lights, glass and every other effect at once.
TEST_P(EveryTechnique, DrawsForwardsPictureWithAllEffects) {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  expect_forwards_picture(s.scene, small_view(47, 31), *GetParam());
}

// The image offset by a fraction of a pixel, as in temporal antialiasing: all passes must use the same
// matrix.
TEST_P(EveryTechnique, DrawsForwardsPictureThroughAJitteredMatrix) {
  const Scene scene = small_scene().scene;
  View view = small_view(47, 31);
  const Image still = render(scene, view, "forward");
  view.clip_from_view[2][0] += 2 * 0.375 / view.width;
  view.clip_from_view[2][1] -= 2 * 0.25 / view.height;
  ASSERT_FALSE(same_bytes(render(scene, view, "forward"), still)) << "the jitter is not seen at all";
  expect_forwards_picture(scene, view, *GetParam());
}

// 2,000 lights that each add a two-thousandth: a sum in half precision stalls, and one in 8 bits never
// starts.
TEST_P(EveryTechnique, SumsManyDimLightsAsOneOfTheirSum) {
  if (GetParam()->limited_lists) return;  // it has places for few lights
  constexpr int count = 2000;
  SmallScene s = small_scene(false);
  const View view = small_view(17, 9);
  add_point(s.scene, "lamp", {0, 0.5f, -3.2f}, {1, 1, 1}, 4, 1.5f);
  const Image one = render(s.scene, view, own_surfaces(*GetParam(), {}) ? GetParam()->name : "forward");
  s.scene.lights[0].intensity /= count;
  s.scene.lights.resize(count, s.scene.lights[0]);
  // Each of the sum's terms may round once.
  EXPECT_LT(compare_images(render(s.scene, view, GetParam()->name), one).max_rel, count * 0x1p-24);
}

INSTANTIATE_TEST_SUITE_P(Techniques, EveryTechnique, testing::ValuesIn(exact_techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

}  // namespace
}  // namespace lightgrid
