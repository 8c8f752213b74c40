#include "oracle/leaks.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid::lab {
namespace {

using testing::HasSubstr;

// A floor of 2 x 2 m that fills the view from 1 m above, between a lamp 1 m below and a shelf of 2 x 1 m half
// a metre above its right half.
struct Cupboard {
  Scene scene;
  View view;

  Cupboard() {
    add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
    const auto add = [&](const char* name, glm::vec3 corner, glm::vec3 right, glm::vec3 up) {
      Mesh mesh;
      shapes::add_quad(mesh, corner, right, up);
      add_instance(scene, name, add_mesh(scene, shapes::finished(std::move(mesh), name, 0)));
    };
    add("floor", {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    add("shelf", {0, 2, 1}, {1, 0, 0}, {0, 0, -2});  // above the eye
    Camera camera = look_at({0, 1, 0}, {0, 0, 0});
    camera.fov_y_rad = 2 * std::atan(1.0);
    view = make_view(camera, 8, 8);
  }
  Light& lamp(glm::vec3 position, float radius_m) {
    return add_point(scene, "lamp", position, {1, 1, 1}, 1, radius_m);
  }
};

TEST(Leaks, AreCountedByLightAndByWhatHidesIt) {
  Cupboard c;
  c.lamp({0.1f, 4, 0},
         100);  // the shelf's shadow, twice its size, falls on x -0.1 to 1.9: five of eight columns
  const Leaks leaks = find_leaks(c.scene, c.view, {});
  EXPECT_EQ(leaks.pixels, 64u);
  EXPECT_EQ(leaks.lit, 64u);
  EXPECT_EQ(leaks.leaked, 32u);
  EXPECT_EQ(leaks.either, 0u);
  ASSERT_EQ(leaks.leaks.size(), 1u);
  EXPECT_EQ(leaks.leaks[0].light, 0);
  EXPECT_EQ(leaks.leaks[0].instance, 1);
  EXPECT_EQ(leaks.leaks[0].pixels, 32u);
  EXPECT_EQ(
      describe(leaks, c.scene, 1),
      "light through walls: 32 of 64 lit pairs of 64 sampled pixels and the lights that cast no shadow\n"
      "  light 0 \"lamp\" shines through node 1 \"shelf\": 32 pixels\n");
}

TEST(Leaks, TheWorstComeFirstAndTheRestAreCounted) {
  Cupboard c;
  c.lamp({0.1f, 4, 0}, 100);
  c.lamp({-0.4f, 4, 0}, 100).name = "other";  // its shadow covers x 0.4 to 2.4
  const Leaks leaks = find_leaks(c.scene, c.view, {});
  ASSERT_EQ(leaks.leaks.size(), 2u);
  EXPECT_GT(leaks.leaks[0].pixels, leaks.leaks[1].pixels);
  EXPECT_THAT(describe(leaks, c.scene, 1), HasSubstr("pixels\n  and 1 more\n"));
}

TEST(Leaks, NeitherLightOutOfRangeNorFromBehindNorOfLightsThatCast) {
  Cupboard c;
  c.lamp({0.1f, 4, 0}, 3);
  c.lamp({0, -1, 0}, 100);  // under the floor: its back hides it, not a wall
  EXPECT_EQ(find_leaks(c.scene, c.view, {}).lit, 0u);
  EXPECT_EQ(find_leaks(c.scene, c.view, {.range = LightRange::infinite}).leaked, 32u);
  c.scene.lights[0].radius_m = 100;
  c.scene.lights[0].casts_shadow = true;
  EXPECT_EQ(find_leaks(c.scene, c.view, {}).lit, 0u);
}

TEST(Leaks, NothingIsInViewOfAnEmptyScene) {
  Cupboard c;
  EXPECT_EQ(find_leaks({}, c.view, {}).pixels, 0u);
}

// Which triangle a pixel shows: the nearest that is drawn.
TEST(Leaks, SurfacesAreThoseThatTheViewShows) {
  Cupboard c;
  c.lamp({0.1f, 0.75f, 0}, 100);
  const auto lit = [&] { return find_leaks(c.scene, c.view, {}).lit; };
  c.scene.instances[1].world_from_object[3].y = -1.5;  // the shelf is now half a metre over the floor
  EXPECT_EQ(lit(), 64u);
  c.scene.instances[1].casts_shadow = false;
  EXPECT_EQ(find_leaks(c.scene, c.view, {}).leaked, 0u);
  c.lamp({0.1f, 0.25f, 0}, 100);  // under the shelf, which is in the way of half of the view
  EXPECT_EQ(lit(), 64u + 32u);
  glm::dmat4& mirrored = c.scene.instances[1].world_from_object;
  mirrored[1].y = -1;
  mirrored[3].y = 2.5;  // at the same place, but now it faces down, and is not drawn
  EXPECT_EQ(lit(), 64u + 64u);
  c.scene.materials[0].double_sided = true;
  EXPECT_EQ(lit(), 64u + 32u);
  c.scene.materials.push_back(c.scene.materials[0]);
  c.scene.meshes[1].material = 1;
  Material& shelf = c.scene.materials[1];
  shelf.alpha_mode = AlphaMode::mask;
  shelf.base_color.a = 0.75f;
  EXPECT_EQ(lit(), 64u + 32u);
  shelf.alpha_cutoff = 0.8f;
  EXPECT_EQ(lit(), 64u + 64u) << "cut out";
  shelf.alpha_mode = AlphaMode::blend;
  EXPECT_EQ(lit(), 64u + 64u);
}

}  // namespace
}  // namespace lightgrid::lab
