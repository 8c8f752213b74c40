#include "oracle/scene_surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/camera.h"

namespace lightgrid::lab {
namespace {

using glm::dvec2, glm::dvec3;

constexpr double eye_height = 1;

// A triangle of ground a metre below the eye, textured by its x and z, from behind the eye to 100 m ahead.
struct Ground {
  Scene scene;
  View view = make_view(look_at({0, 0, 0}, {0, 0, -1}), 40, 30);

  Ground() {
    Mesh mesh;
    mesh.positions = {{-100, -1, 50}, {100, -1, 50}, {0, -1, -100}};
    mesh.normals.assign(3, {0, 1, 0});
    mesh.tangents.assign(3, {1, 0, 0, 1});
    for (const glm::vec3& p : mesh.positions) mesh.uv0.push_back({p.x, p.z});
    mesh.indices = {0, 1, 2};
    scene.meshes = {mesh};
    scene.materials = {Material{}};
    scene.instances = {Instance{}};
    Bitmap bitmap{"noise", 8, 8, {}};
    for (int i = 0; i < 8 * 8 * 4; ++i) bitmap.rgba.push_back(uint8_t(i * i * 37 + 11 * i));
    scene.bitmaps = {bitmap};
    scene.textures = {Texture{.bitmap = 0}};
  }

  // By rays: place = pixels, distance = height over the slope of the ray.
  struct Seen {
    double distance;
    dvec2 uv, right, up;
  };
  Seen seen_at(const dvec2& place) const {
    const dvec2 step = 2.0 / dvec2(40 * view.clip_from_view[0][0], 30 * view.clip_from_view[1][1]);
    const dvec2 slope = (place - dvec2(20, 15)) * step;
    const double distance = eye_height / -slope.y, grows = eye_height / (slope.y * slope.y) * step.y;
    return {distance, {slope.x * distance, -distance}, {step.x * distance, 0}, {slope.x * grows, -grows}};
  }
};

TEST(SceneSurfaces, DepthIsNearOverDistanceOnGroundThatPassesTheEye) {
  const Ground ground;
  const SceneSurfaces surfaces(ground.scene, ground.view);
  const TriangleInView triangle = surfaces.triangle(0, {0, 1, 2});
  EXPECT_GT(triangle.turn(), 0);
  for (const dvec2& place : {dvec2(3.5, 2.5), dvec2(20.5, 11.5), dvec2(37.5, 9.5)}) {
    const std::optional<double> depth = surfaces.depth_at(triangle, place);
    ASSERT_TRUE(depth);
    EXPECT_NEAR(*depth, ground.view.near_m / ground.seen_at(place).distance, 1e-14);
  }
  EXPECT_FALSE(surfaces.depth_at(triangle, {20.5, 20.5})) << "above the horizon";
  EXPECT_FALSE(surfaces.depth_at(triangle, {0.5, 14.57})) << "beside the triangle, 60 m ahead";
}

TEST(SceneSurfaces, TexturesAreTakenWithTheDerivativesOfTheRays) {
  Ground ground;
  ground.scene.materials[0].base_color_map.texture = 0;
  ground.scene.materials[0].base_color = {0.5f, 1, 1, 1};
  SceneSurfaces surfaces(ground.scene, ground.view);
  TextureSampler sampler(ground.scene.bitmaps[0], ground.scene.textures[0]);
  const TriangleInView triangle = surfaces.triangle(0, {0, 1, 2});
  for (const dvec2& place : {dvec2(3.5, 2.5), dvec2(20.5, 11.5), dvec2(37.5, 9.5), dvec2(17.5, 13.5)}) {
    const Ground::Seen seen = ground.seen_at(place);
    const glm::dvec4 expected = sampler.at(seen.uv, seen.right, seen.up) * glm::dvec4(0.5, 1, 1, 1),
                     found = surfaces.base_color_at(triangle, place);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(found[c], expected[c], 1e-10) << place.y;
  }
}

// u and v of a texture turned by a quarter, twice as dense, shifted: the same as by hand.
TEST(SceneSurfaces, ASlotTransformsPlacesAndDerivatives) {
  Ground ground;
  TextureSlot& slot = ground.scene.materials[0].base_color_map;
  slot = {.texture = 0, .uv_from_vertex = {0, 2, -2, 0, 0.25f, 0.5f}};
  SceneSurfaces surfaces(ground.scene, ground.view);
  TextureSampler sampler(ground.scene.bitmaps[0], ground.scene.textures[0]);
  const auto turned = [](const dvec2& v) { return dvec2(-2 * v.y, 2 * v.x); };
  const dvec2 place(25.5, 6.5);
  const Ground::Seen seen = ground.seen_at(place);
  const glm::dvec4 expected =
      sampler.at(turned(seen.uv) + dvec2(0.25, 0.5), turned(seen.right), turned(seen.up));
  EXPECT_NEAR(surfaces.base_color_at(surfaces.triangle(0, {0, 1, 2}), place).g, expected.g, 1e-10);
}

// A texel of (0.6, 0, 1) after its mapping to -1 to 1, at scale 2: (1.2, 0, 1) along x, -z and y.
TEST(SceneSurfaces, NormalMapsTiltByTheirScaleAndBackSidesFaceTheEye) {
  Ground ground;
  ground.scene.bitmaps[0] = {"tilted", 1, 1, {204, 128, 255, 255}};
  Material& m = ground.scene.materials[0];
  m.normal_map.texture = 0;
  m.normal_scale = 2;
  m.double_sided = true;
  m.metallic = 0.25f;
  m.roughness = 0.5f;
  SceneSurfaces surfaces(ground.scene, ground.view);
  const dvec3 expected = glm::normalize(dvec3(1.2, 1, -2 * (128 / 127.5 - 1)));
  const Surface s = surfaces.surface_at(surfaces.triangle(0, {0, 1, 2}), {20.5, 5.5});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.normal[c], expected[c], 1e-14) << c;
  EXPECT_EQ(s.metallic, 0.25);
  EXPECT_EQ(s.roughness, 0.5);
  const TriangleInView turned = surfaces.triangle(0, {0, 2, 1});
  EXPECT_LT(turned.turn(), 0);
  EXPECT_NEAR(surfaces.surface_at(turned, {20.5, 5.5}).normal.y, -expected.y, 1e-14);
}

}  // namespace
}  // namespace lightgrid::lab
