// EXT_lights_image_based.
#include <cmath>
#include <numbers>

#include "base/image.h"
#include "scene/environment_light.h"
#include "support/error_of.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using glm::dvec3;
using nlohmann::json;
constexpr double sphere_pi = std::numbers::pi;
using testing::HasSubstr;

// Irradiance sphere_pi (1 + 2/3 y) in all colours, as radiance 1 + y has.
json coefficients() {
  json rows;
  for (int i = 0; i < 9; ++i) {
    const double c = i == 0 ? sphere_pi / 0.282095 : i == 1 ? 2 * sphere_pi / 3 / 0.488603 : 0;
    rows.push_back({c, c, c});
  }
  return rows;
}

std::string rgbd_face(uint8_t red, uint8_t green, uint8_t alpha) {
  return "data:image/png;base64," + base64(encode_png(1, 1, 4, {red, green, 0, alpha}));
}

GltfBuilder surrounded(json light) {
  GltfBuilder made = GltfBuilder::triangle();
  light["irradianceCoefficients"] = coefficients();
  made.root["extensionsUsed"] = {"EXT_lights_image_based"};
  made.root["extensions"]["EXT_lights_image_based"]["lights"] = {light};
  made.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return made;
}

// Red rises with the face, +x, -x, +y, -y, +z, -z.
void add_faces(GltfBuilder& made) {
  for (int i = 0; i < 6; ++i)
    made.root["images"].push_back({{"uri", rgbd_face(uint8_t(100 + 20 * i), 0, 255)}});
  made.root["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"] = {{0, 1, 2, 3, 4, 5}};
}

double linear_of(int byte) { return double(linear_from_srgb(float(byte) / 255)); }

double red_towards(const Scene& scene, const dvec3& d) { return lobe_radiance(*scene.environment, d, 0).r; }

TEST(GltfImageBasedLight, FacesAreWhereTheyLook) {
  GltfBuilder made = surrounded({{"intensity", 2}});
  add_faces(made);
  const Scene scene = made.load();
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.ambient, glm::vec3(0));
  const dvec3 towards[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(red_towards(scene, towards[i]), 2 * linear_of(100 + 20 * i), 1e-6) << i;
  // The coefficients decide, whatever the faces are: the integrals of 2 (1 + y), of it times y, and times y^2.
  const auto& m = scene.environment->moments[1];
  EXPECT_NEAR(m[3] + m[4] + m[5], 8 * sphere_pi, 1e-4);
  EXPECT_NEAR(m[1], 8 * sphere_pi / 3, 1e-4);
  EXPECT_NEAR(m[4], 8 * sphere_pi / 3, 1e-4);
}

TEST(GltfImageBasedLight, RotationTurnsFacesAndCoefficients) {
  // A quarter turn about z: +x of the light looks along +y, +y along -x.
  GltfBuilder made = surrounded({{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
  add_faces(made);
  const Scene scene = made.load();
  EXPECT_NEAR(red_towards(scene, {0, 1, 0}), linear_of(100), 1e-6);
  EXPECT_NEAR(red_towards(scene, {-1, 0, 0}), linear_of(140), 1e-6);
  EXPECT_NEAR(scene.environment->moments[0][0], -4 * sphere_pi / 3, 1e-4);
  EXPECT_NEAR(scene.environment->moments[0][1], 0, 1e-6);
}

TEST(GltfImageBasedLight, AlphaDividesColours) {
  GltfBuilder made = surrounded(json::object());
  add_faces(made);
  made.root["images"][0]["uri"] = rgbd_face(100, 0, 51);
  EXPECT_NEAR(red_towards(made.load(), {1, 0, 0}), 5 * linear_of(100), 1e-5);
}

TEST(GltfImageBasedLight, CoefficientsStandInForMissingFaces) {
  const Scene scene = surrounded(json::object()).load();
  EXPECT_NEAR(red_towards(scene, {0, 1, 0}), 2, 0.01);
  EXPECT_NEAR(red_towards(scene, {1, 0, 0}), 1, 0.01);
  EXPECT_NEAR(red_towards(scene, {0, -1, 0}), 0, 0.01);
}

TEST(GltfImageBasedLight, AmbientOfTheExtrasIsAdded) {
  GltfBuilder made = surrounded(json::object());
  made.root["scenes"][0]["extras"]["lightgrid"]["ambient"] = {0.5, 0.5, 0.5};
  EXPECT_EQ(made.load().ambient, glm::vec3(0.5f));
}

TEST(GltfImageBasedLight, FaultsAreErrors) {
  const auto fault = [](const std::function<void(json&)>& change) {
    GltfBuilder made = surrounded(json::object());
    change(made.root);
    return error_of([&] { made.load(); });
  };
  const auto light = [](json& root) -> json& {
    return root["extensions"]["EXT_lights_image_based"]["lights"][0];
  };
  EXPECT_THAT(
      fault([&](json& root) { root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 3; }),
      HasSubstr("EXT_lights_image_based.light is 3"));
  EXPECT_THAT(fault([&](json& root) { light(root)["irradianceCoefficients"].erase(8); }),
              HasSubstr("irradianceCoefficients"));
  EXPECT_THAT(fault([&](json& root) {
                light(root)["irradianceCoefficients"][4] = {1, 2};
              }),
              HasSubstr("irradianceCoefficients[4]"));
  EXPECT_THAT(fault([&](json& root) { light(root)["rotation"] = {0, 0, 0, 0}; }), HasSubstr("rotation"));
  EXPECT_THAT(fault([&](json& root) { light(root)["intensity"] = -1; }), HasSubstr("intensity"));
  EXPECT_THAT(fault([&](json& root) {
                light(root)["specularImages"] = {{0, 1, 2, 3, 4, 99}};
              }),
              HasSubstr("specularImages[0]"));
}

}  // namespace
}  // namespace lightgrid
