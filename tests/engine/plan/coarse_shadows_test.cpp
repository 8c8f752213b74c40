#include "plan/coarse_shadows.h"

#include <gmock/gmock.h>

#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// Three lamps near the middle, and one far away with its own range. The box is 2 m wide: its diagonal 3.5 m.
Scene lamps_and_one(double away_m, float range_m) {
  Scene scene;
  add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
  Mesh box;
  shapes::add_box(box, {-1, -1, -1}, {1, 1, 1});
  add_instance(scene, "box", add_mesh(scene, shapes::finished(std::move(box), "box", 0)), placed({0, 0, 0}));
  for (int i = 0; i < 3; ++i) add_point(scene, "lamp", {float(i), 2, 0}, {1, 1, 1}, 1, 5);
  add_point(scene, "beacon", {float(away_m), 0, 0}, {1, 1, 1}, 1, range_m);
  for (Light& light : scene.lights) light.casts_shadow = true;
  return scene;
}

TEST(CoarseShadows, AreThoseOfALightWhoseLastPartIsLargeForItsRange) {
  EXPECT_EQ(coarse_shadows(lamps_and_one(9000, 5), {}).lights, 0) << "9.6 mm";
  const CoarseShadows coarse = coarse_shadows(lamps_and_one(1e7, 5), {});
  EXPECT_EQ(coarse.lights, 1);
  EXPECT_EQ(coarse.first_light, 3);
  EXPECT_NEAR(coarse.gap_m, 1e-3 + 1e7 * 0x1p-20, 1e-4);
  EXPECT_EQ(coarse_shadows(lamps_and_one(1e7, 1e5f), {}).lights, 0) << "9.5 m of 100 km";
  Scene without = lamps_and_one(1e7, 5);
  without.lights[3].casts_shadow = false;
  EXPECT_EQ(coarse_shadows(without, {}).lights, 0);
}

TEST(CoarseShadows, OfADirectionalLightAreThoseOnFarInstances) {
  Scene scene = lamps_and_one(10, 5);
  add_instance(scene, "moon", 0, placed({0, 1e7, 0}));
  EXPECT_EQ(coarse_shadows(scene, {}).instances, 0) << "no sun";
  Light& sun = add_point(scene, "sun", {0, 0, 0}, {1, 1, 1}, 1, 5);
  sun.type = LightType::directional;
  sun.casts_shadow = true;
  const CoarseShadows coarse = coarse_shadows(scene, {});
  EXPECT_EQ(coarse.instances, 1);
  EXPECT_EQ(coarse.first_instance, 1);
  EXPECT_THAT(describe(coarse, scene), HasSubstr("on 1 instance (the first: 1 \"moon\")"));
  EXPECT_THAT(describe(coarse, scene), HasSubstr("last 9.5 m"));
  // A planet: 9.5 m are little for it.
  scene.instances[1].world_from_object = placed({0, 1e7, 0}, 0, 1e4);
  EXPECT_EQ(coarse_shadows(scene, {}).instances, 0);
}

TEST(CoarseShadows, AreNotMentionedWhereThereAreNone) { EXPECT_EQ(describe(CoarseShadows(), Scene()), ""); }

}  // namespace
}  // namespace lightgrid
