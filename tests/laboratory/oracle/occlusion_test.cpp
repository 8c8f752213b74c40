#include "oracle/occlusion.h"

#include <gtest/gtest.h>

#include "oracle/shadow_scenes.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

// 2 m above the ground, over x 0 to 2 and z -2 to 2.
Mesh roof_mesh(int material = 0) {
  return mesh_of({{0, 2, -2}, {0, 2, 2}, {2, 2, 2}, {0, 2, -2}, {2, 2, 2}, {2, 2, -2}}, material);
}

Sight sight_of(const Occlusion& occlusion, const Light& light, const dvec3& place) {
  return occlusion.sight(light, receiver_at(place)).sight;
}

// Each coordinate may be off by half a unit in the last place, relative to the rays' origin. Far away that is
// 99,968 m along x, rounded itself.
TEST(Occlusion, VerticesAreOffByTheirRoundingRelativeToTheOrigin) {
  EXPECT_NEAR(Occlusion(scene_of({ground_mesh()})).rounded({10, 0, -10}).error_m,
              std::sqrt(3.0) * 10 * 0x1p-24, 1e-12);
  Scene far = scene_of({ground_mesh()});
  far.instances[0].world_from_object[3] = {1e5, 0, 0, 1};
  EXPECT_NEAR(Occlusion(far).rounded({1e5 + 10, 0, -10}).error_m,
              std::sqrt(3.0) * (42 + 99968 * 0x1p-24) * 0x1p-24, 1e-12);
}

TEST(Occlusion, AFarInstanceLeavesTheOthersVerticesWhereTheyAre) {
  Scene scene = scene_of({ground_mesh(), roof_mesh(), roof_mesh()});
  const RoundedPoint near = Occlusion(scene).rounded({2, 2, 2});
  scene.instances[2].world_from_object[3] = {1e7, 1e7, -1e7, 1};
  EXPECT_EQ(Occlusion(scene).rounded({2, 2, 2}).error_m, near.error_m);
  EXPECT_LT(near.error_m, 1e-6);
}

// Light at (1, 4, 0): the roof, half as high, throws a shadow twice as large, x -1 to 3 and z -4 to 4.
TEST(Occlusion, ARoofHalfWayUpHidesTwiceItsSize) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  const Light light = light_at({1, 4, 0});
  EXPECT_EQ(sight_of(occlusion, light, {2.9, 0, 0}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light, {3.1, 0, 0}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light, {-0.9, 0, -3.9}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light, {-0.9, 0, -4.1}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light, {3, 0, 0}), Sight::either) << "at the edge itself";
}

// 8 m to the receiver less 2 mm: the roof is 2 * sqrt(2) m of 4 * sqrt(2) away.
TEST(Occlusion, TellsTheTriangleThatHidesAndHowFarItIsFromTheLight) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  const SightAnswer below = occlusion.sight(light_at({0, 4, 1.5}), receiver_at({2, 0, 1}));
  ASSERT_EQ(below.sight, Sight::hidden);
  EXPECT_EQ(below.by, (CastingTriangle{1, 0})) << "z 1.25 of the roof at x 1";
  EXPECT_NEAR(below.distance_m, std::sqrt(1 + 4 + 0.0625), 1e-12);
}

// (1, 2, 0) lies on the roof's diagonal: whichever triangle it is in, it hides. On the edge x = 0 none may.
TEST(Occlusion, AnEdgeOfTwoTrianglesHidesAsTheirInsideDoes) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  EXPECT_EQ(sight_of(occlusion, light_at({1, 4, 0}), {1, 0, 0}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light_at({1.5, 4, 0.5}), {0.5, 0, -0.5}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light_at({0, 4, 0}), {0, 0, 0}), Sight::either);
}

// Two sheets that meet in a fold, both on the same side of the edge: a ray past it meets neither.
TEST(Occlusion, TheOuterEdgeOfAFoldIsInDoubt) {
  const Mesh fold = mesh_of({{0, 2, -2}, {0, 2, 2}, {2, 2, 0}, {0, 2, 2}, {0, 2, -2}, {2, 1, 0}});
  const Scene scene = scene_of({ground_mesh(), fold});
  const Occlusion occlusion(scene);
  EXPECT_EQ(sight_of(occlusion, light_at({0, 4, 0}), {0, 0, 0}), Sight::either);
  EXPECT_EQ(sight_of(occlusion, light_at({0.1, 4, 0}), {0.1, 0, 0}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light_at({-0.1, 4, 0}), {-0.1, 0, 0}), Sight::seen);
}

TEST(Occlusion, AnInstanceThatCastsNoShadowHidesNothingButWhatIsBehindItsOwnTriangles) {
  Scene scene = scene_of({ground_mesh(), roof_mesh()});
  for (Instance& instance : scene.instances) instance.casts_shadow = false;
  const Occlusion occlusion(scene);
  EXPECT_EQ(sight_of(occlusion, light_at({1, 4, 0}), {2.9, 0, 0}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light_at({1, -1, 0}), {3, 0, 1}), Sight::hidden);
}

TEST(Occlusion, TheOwnTriangleHidesALightBehindIt) {
  const Scene scene = scene_of({ground_mesh()});
  const Occlusion occlusion(scene);
  const SightAnswer below = occlusion.sight(light_at({1, -1, 0}), receiver_at({3, 0, 1}));
  EXPECT_EQ(below.sight, Sight::hidden);
  EXPECT_EQ(below.by, (CastingTriangle{0, 0}));
  EXPECT_EQ(sight_of(occlusion, light_at({1, 1e-3, 0}), {3, 0, 1}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light_at({1, 0, 0}), {3, 0, 1}), Sight::either);
}

// A step half a millimetre above the ground: less than the gap straight down, more at a slant of 1 in 10.
TEST(Occlusion, TheLastMillimetreHidesNothing) {
  const Mesh step = mesh_of({{-9, 0.0005f, -9}, {9, 0.0005f, 9}, {9, 0.0005f, -9}});
  const Scene scene = scene_of({ground_mesh(), step});
  const Occlusion occlusion(scene);
  EXPECT_EQ(sight_of(occlusion, light_at({3, 2, 1}), {3, 0, 1}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light_at({5, 0.2, 1}), {3, 0, 1}), Sight::hidden);
}

// At y 2, on the roof's plane: over its hole, beside it, and on the roof itself.
TEST(Occlusion, ALightInATrianglesPlaneIsNotHiddenByItFromAside) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  EXPECT_EQ(sight_of(occlusion, light_at({5, 2, 0}), {1, 0, 0}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light_at({1, 2, 0.5}), {1, 0, 0.2}), Sight::either) << "on the roof";
}

// Down along (3, -4, 0): the roof's shadow lies 1.5 m further along x, 1.5 to 3.5.
TEST(Occlusion, DirectionalLightsComeFromFarAway) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  Light sun;
  sun.type = LightType::directional;
  sun.direction = {0.6f, -0.8f, 0};
  EXPECT_EQ(sight_of(occlusion, sun, {1.4, 0, 0}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, sun, {3.4, 0, 0}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, sun, {3.6, 0, 0}), Sight::seen);
  EXPECT_NEAR(occlusion.sight(sun, receiver_at({2.5, 0, 0.7})).distance_m, 2.5, 1e-3);
  sun.direction = {0.6f, 0.8f, 0};
  EXPECT_EQ(sight_of(occlusion, sun, {1, 0, 0}), Sight::hidden) << "from below";
}

TEST(Occlusion, BlendedSurfacesHideNothing) {
  Scene scene = scene_of({ground_mesh(), roof_mesh(1)});
  scene.materials.push_back({.alpha_mode = AlphaMode::blend});
  EXPECT_EQ(sight_of(Occlusion(scene), light_at({1, 4, 0}), {1, 0, 0.5}), Sight::seen);
}

// Alpha 0 to 255 along u, from x 0 to 2 in two texels: 1/2 at x 1, where the light sees x 1 of the ground.
TEST(Occlusion, MasksHideWhereTheirAlphaIsAtLeastTheCutoff) {
  Scene scene = scene_of({ground_mesh(), roof_mesh(1)});
  scene.bitmaps = {{"ramp", 2, 1, {0, 0, 0, 0, 0, 0, 0, 255}}};
  scene.textures = {{.bitmap = 0, .wrap_u = Wrap::clamp}};
  Material ramp{.alpha_mode = AlphaMode::mask, .alpha_cutoff = 0.5f};
  ramp.base_color_map.texture = 0;
  scene.materials.push_back(ramp);
  for (const glm::vec3& p : scene.meshes[1].positions) scene.meshes[1].uv0.push_back({p.x / 2, 0.5f});
  const Occlusion occlusion(scene);
  const Light light = light_at({1, 4, 0.3});
  EXPECT_EQ(sight_of(occlusion, light, {0.98, 0, 0}), Sight::seen);
  EXPECT_EQ(sight_of(occlusion, light, {1.02, 0, 0}), Sight::hidden);
  EXPECT_EQ(sight_of(occlusion, light, {1, 0, 0}), Sight::either);
  scene.materials[1].base_color.a = 0.4f;
  EXPECT_EQ(sight_of(occlusion, light, {2.9, 0, 0}), Sight::seen) << "0.4 at most";
}

// The view looks straight down from 5 m, 90 degrees high: pixel (x, y) of 10 x 10 shows 1 m of the ground.
TEST(Occlusion, APixelsReceiverLiesInItsTrianglesPlane) {
  const Scene scene = scene_of({ground_mesh(), roof_mesh()});
  const Occlusion occlusion(scene);
  Camera camera = look_at({0, 5, 0}, {0, 0, 0});
  camera.fov_y_rad = 1.5707963267948966;
  const View view = make_view(camera, 10, 10);
  const double wrong = 1e-5;  // relative to the depth
  const Receiver r = occlusion.receiver(view, 7, 7, view.near_m / 5 * (1 + wrong), {0, 0});
  EXPECT_NEAR(r.place.place.x, 2.5 * (1 - wrong), 1e-9);
  EXPECT_NEAR(r.place.place.y, 0, 1e-12);
  EXPECT_NEAR(r.place.place.z, -2.5 * (1 - wrong), 1e-9);
  EXPECT_LT(r.place.error_m, 3e-5);
  EXPECT_NEAR(r.gap_m, 1e-3 + 0x1p-20 * glm::length(dvec3(2.5, 0, 2.5)), 1e-9)
      << "from the origin, which is the median of the instances in steps of 64 m";
  EXPECT_EQ(r.eye.place, dvec3(0, 5, 0));
}

}  // namespace
}  // namespace lightgrid::lab
