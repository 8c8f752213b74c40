// Small generated glTF models: a plate that fills the picture, so that pixels can be computed by hand.
#pragma once

#include <algorithm>

#include <glm/gtc/constants.hpp>

#include "base/image.h"
#include "conformance/double_errors.h"
#include "conformance/picture.h"
#include "plan/settings/kernels.h"
#include "support/gltf_builder.h"

namespace lightgrid {

inline constexpr int own_size = 64;  // pixels

// A plate from (-1, -1, 0) to (1, 1, 0) that faces +z, uv (0, 0) at its upper left. Its camera looks along -z
// without perspective, so that every pixel sees it along its normal.
inline GltfBuilder plate() {
  GltfBuilder made;
  made.root["scenes"] = {{{"nodes", {0, 1}}}};
  made.root["nodes"] = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 5}}}};
  made.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 9}}}}};
  made.root["meshes"] = {{{"primitives", {{{"attributes", nlohmann::json::object()}, {"material", 0}}}}}};
  made.root["materials"] = {nlohmann::json::object()};
  made.attribute("POSITION", std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", f32, 4);
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 4);
  made.attribute("TEXCOORD_0", std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", f32, 4);
  made.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, u16);
  return made;
}

inline nlohmann::json& material_of(GltfBuilder& made) { return made.root["materials"][0]; }

inline nlohmann::json unlit(const glm::vec4& color) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", {color.r, color.g, color.b, color.a}}}},
          {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}};
}

inline GltfBuilder unlit_plate(const glm::vec4& color) {
  GltfBuilder made = plate();
  material_of(made) = unlit(color);
  return made;
}

inline GltfBuilder lit_plate(const glm::vec3& color, float metallic = 0, float roughness = 1) {
  GltfBuilder made = plate();
  material_of(made)["pbrMetallicRoughness"] = {{"baseColorFactor", {color.r, color.g, color.b, 1}},
                                               {"metallicFactor", metallic},
                                               {"roughnessFactor", roughness}};
  return made;
}

// The index of a new texture with unfiltered texels; glTF's wrap modes.
inline int add_texels(GltfBuilder& made, int width, int height, int channels, const Bytes& texels,
                      int wrap_s = 10497, int wrap_t = 10497) {
  nlohmann::json& root = made.root;
  const std::string uri = "data:image/png;base64," + base64(encode_png(width, height, channels, texels));
  root["images"].push_back({{"uri", uri}});
  root["samplers"].push_back(
      {{"magFilter", 9728}, {"minFilter", 9728}, {"wrapS", wrap_s}, {"wrapT", wrap_t}});
  const int index = int(root["textures"].size());
  root["textures"].push_back(
      {{"source", root["images"].size() - 1}, {"sampler", root["samplers"].size() - 1}});
  return index;
}

// Red, green over blue, white.
inline int add_four_colors(GltfBuilder& made, int wrap_s = 10497, int wrap_t = 10497) {
  return add_texels(made, 2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}, wrap_s, wrap_t);
}

// The node of a new light, in the scene.
inline nlohmann::json& add_light(GltfBuilder& made, const nlohmann::json& light) {
  nlohmann::json& lights = made.root["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  nlohmann::json& nodes = made.root["nodes"];
  made.root["scenes"][0]["nodes"].push_back(nodes.size());
  nodes.push_back({{"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
  return nodes.back();
}

// The technique visibility shows the surfaces that the double rasteriser and filter find. Pixels' centres lie
// on the plate's diagonal: on which of its two triangles is not compared.
inline void expect_visibility_agrees(const Scene& scene, const View& view) {
  for (const Instance& instance : scene.instances) {
    if (scene.materials[scene.meshes[instance.mesh].material].alpha_mode == AlphaMode::blend) return;
  }
  const DoubleErrors e = errors_against_double(scene, view, {{setting::everything_on, true}});
  EXPECT_LE(e.elsewhere, size_t(2 * own_size));
  EXPECT_LT(e.mean, 1e-6);
  EXPECT_LT(e.largest, 2e-5);
}

// From its own camera, with its own lights only.
inline Picture shown(Scene scene) {
  scene.ambient = glm::vec3(0);
  Picture picture{make_view(scene.cameras.at(0), own_size, own_size), {}};
  picture.image = render_image(scene, picture.view);
  EXPECT_EQ(count_nan_pixels(picture.image), 0u);
  expect_visibility_agrees(scene, picture.view);
  return picture;
}
inline Picture shown(const GltfBuilder& made) {
  set_log_level(LogLevel::quiet);
  return shown(made.load());
}

// The centre of a pixel: column from the left, row from the bottom.
inline glm::dvec3 pixel_center(int column, int row) {
  return {(column + 0.5) * 2 / own_size - 1, (row + 0.5) * 2 / own_size - 1, 0};
}

// Compares radiances, up to the rounding of a few float operations.
inline void expect_radiance(const glm::vec3& found, const glm::dvec3& expected) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(found[c], expected[c], 2e-6 * std::max(1.0, expected[c])) << "channel " << c;
}

// Upper left, upper right, lower left, lower right.
inline void expect_quarters(const Picture& picture, const std::array<glm::dvec3, 4>& expected) {
  const glm::dvec3 places[] = {{-0.5, 0.5, 0}, {0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}};
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    expect_radiance(picture.at(places[i]), expected[i]);
  }
}

inline constexpr glm::dvec3 black(0), white(1), red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);

}  // namespace lightgrid
