// Cookies: every technique against forward. Hard cases against the oracle: laboratory/verify/effect_rows.cpp.
#include "scenes/cookie_image.h"

#include "support/small_scene.h"
#include "techniques/against_the_oracle.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

struct LightCookiesOf : testing::TestWithParam<const Technique*> {};

TEST_P(LightCookiesOf, AreThoseOfForward) {
  if (GetParam()->approximate) GTEST_SKIP() << "draws another picture";
  SmallScene s = small_scene();
  for (const char* name : {"blend", "spot", "directional", "groups", "profiles", "cookies"})
    effect(name).add(s);
  const View view = small_view(47, 31);
  const Image forward = render(s.scene, view, "forward");
  ASSERT_GT(compare_images(render(s.scene, view, "forward", assigned("light-cookies=off")), forward).max_rel,
            0.05);
  expect_close(s.scene, view, {}, forward, GetParam()->name, other_order);
}

INSTANTIATE_TEST_SUITE_P(Techniques, LightCookiesOf, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

TEST(LightCookies, HaveTheSameBytesInBothKernelShapes) {
  SmallScene s = small_scene();
  for (const char* name : {"spot", "cookies"}) effect(name).add(s);
  const View view = small_view(61, 47);
  const Image lanes = render(s.scene, view, "visibility", assigned("kernel-shape=lanes"));
  EXPECT_TRUE(identical(render(s.scene, view, "visibility", assigned("kernel-shape=group")), lanes));
  EXPECT_TRUE(identical(render(s.scene, view, "visibility", assigned("portable=on")), lanes));
}

TEST(LightCookies, AreNothingWhereNoLightHasOne) {
  const SmallScene s = small_scene();
  const View view = small_view(31, 23);
  for (const char* technique : {"forward_plus", "visibility"}) {
    TechniqueRun with(test_devices(), s.scene, view, {}, find_technique(technique));
    TechniqueRun without(test_devices(), s.scene, view, assigned("light-cookies=off"),
                         find_technique(technique));
    with.run_frame();
    without.run_frame();
    EXPECT_TRUE(with.view().plan.effects.empty());
    EXPECT_TRUE(identical(with.image(), without.image()));
    EXPECT_EQ(with.result().memory_total, without.result().memory_total);
  }
}

}  // namespace
}  // namespace lightgrid
