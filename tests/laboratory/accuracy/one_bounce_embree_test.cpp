// Virtual lights against the truth of one bounce. Skipped without Embree.
#include <gtest/gtest.h>

#include "support/devices.h"
#include "support/small_scene.h"
#include "support/virtual_light_error.h"

namespace lightgrid::lab {
namespace {

#ifdef LIGHTGRID_EMBREE

Settings lambert_settings() {
  Settings s;
  apply_setting(s, "brdf=lambert");
  return s;
}

Scene room(Mesh mesh, glm::vec3 color, const Light& light) {
  Scene scene;
  scene.name = "room";
  const int walls = add_material(scene, "walls", color, 0, 1);
  scene.materials[size_t(walls)].double_sided = true;
  add_instance(scene, "walls", add_mesh(scene, shapes::finished(std::move(mesh), "walls", walls)));
  scene.lights = {light};
  return scene;
}

// A screen stands in a room, and hides the lamp and one half from the other.
Scene divided_room() {
  Mesh mesh;
  shapes::add_box(mesh, {-3, 0, -3}, {3, 3, 3});
  Light lamp;
  lamp.position = {-1.5, 1.8, 0.4};
  lamp.intensity = 40;
  lamp.color = {1, 0.8f, 0.6f};
  Scene scene = room(std::move(mesh), {0.6f, 0.5f, 0.4f}, lamp);
  Mesh screen;
  shapes::add_box(screen, {-0.1f, 0, -1.5f}, {0.1f, 2.4f, 3});
  const int blue = add_material(scene, "blue", {0.2f, 0.3f, 0.8f}, 0, 1);
  add_instance(scene, "screen", add_mesh(scene, shapes::finished(std::move(screen), "screen", blue)));
  return scene;
}

View room_view() { return make_view(look_at({2.6, 1.6, -2.6}, {-1, 1, 1}), 160, 90); }

// E = albedo I / R^2 everywhere: run/virtual_lights_test.cpp.
TEST(OneBounce, IsKnownInASphere) {
  Mesh mesh;
  shapes::add_sphere(mesh, {0, 0, 0}, 2, 24);
  Light lamp;
  lamp.intensity = 30;
  const Scene scene = room(std::move(mesh), glm::vec3(0.5f), lamp);
  const View view = make_view(look_at({0.5, 0.3, 0.8}, {0.2, 0.1, -1}), 32, 18);
  OneBounceView seen(opencl_devices(), scene, view, lambert_settings(), 40, 256);
  const double expected = 0.5 / std::numbers::pi * 0.5 * 30 / 4;
  EXPECT_NEAR(seen.truth_mean() / expected, 1, 0.01);
  for (const glm::dvec3& t : seen.truth()) EXPECT_NEAR(t.g / expected, 1, 0.02);
}

TEST(OneBounce, IsWhatShadowedVirtualLightsTendTo) {
  OneBounceView seen(opencl_devices(), divided_room(), room_view(), lambert_settings(), 400, 1024);
  EXPECT_LT(seen.truth_noise(), 0.04);
  const VirtualLightError few = seen.error({.count = 64}, true, 3),
                          many = seen.error({.count = 1024}, true, 3);
  EXPECT_NEAR(many.bias, 0, 0.02);
  EXPECT_LT(many.rms, 0.15);
  EXPECT_LT(many.spread, few.spread / 2);
  // The walls' other half is in the lamp's shadow, and in that of most of what reflects it.
  const VirtualLightError unhidden = seen.error({.count = 1024}, false, 1);
  EXPECT_GT(unhidden.bias, 0.1);
}

TEST(OneBounce, LosesWhatTheClampTakesAway) {
  OneBounceView seen(opencl_devices(), divided_room(), room_view(), lambert_settings(), 400, 512);
  const VirtualLightError wide = seen.error({.count = 256, .nearest_m = 1}, true, 3),
                          automatic = seen.error({.count = 256}, true, 3),
                          none = seen.error({.count = 256, .nearest_m = 0}, true, 3);
  EXPECT_LT(wide.bias, automatic.bias - 0.01);
  EXPECT_LT(automatic.bias, none.bias);
  EXPECT_LT(automatic.spread, none.spread);
}

#else

TEST(OneBounce, NeedsEmbree) { GTEST_SKIP() << "Embree is not installed (libembree-dev)"; }

#endif

}  // namespace
}  // namespace lightgrid::lab
