// Geometry and nodes from a file to the picture, computed by hand. The plate is white and unlit, so that a
// pixel shows whether it is covered.
#include "conformance/own_model.h"

namespace lightgrid {
using namespace lab;
namespace {

using nlohmann::json;
using Floats = std::vector<float>;

GltfBuilder white_plate() { return unlit_plate({1, 1, 1, 1}); }

bool same_pixels(const Picture& a, const Picture& b) { return a.image.pixels == b.image.pixels; }

// Bytes as values: the byte's fraction of 255, linear, times the factor; interpolated between vertices.
TEST(OwnGeometry, VertexColoursOfBytesAndShortsAreLinearAndTimesTheFactor) {
  GltfBuilder made = unlit_plate({1, 0.5f, 0.25f, 1});
  const Bytes colors = {0, 255, 51, 255, 255, 255, 51, 255, 255, 255, 51, 255, 0, 255, 51, 255};
  made.attribute("COLOR_0", colors, "VEC4", u8, 4, true);
  const Picture bytes = shown(made);
  for (const int column : {0, 17, 63}) {
    expect_radiance(bytes.image.at(column, 40), {(column + 0.5) / own_size, 0.5, 0.2 * 0.25});
  }
  std::vector<uint16_t> wide;
  for (const uint8_t value : colors) wide.push_back(uint16_t(257 * value));
  made.attribute("COLOR_0", wide, "VEC3", u16, 4, true, 8);
  EXPECT_TRUE(same_pixels(shown(made), bytes));
}

TEST(OwnGeometry, NormalisedUvsAndNormals) {
  GltfBuilder made = lit_plate({1, 1, 1});
  material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_four_colors(made)}};
  add_light(made, {{"type", "directional"}, {"intensity", 2}});
  const Picture floats = shown(made);
  EXPECT_GT(floats.at({-0.5, 0.5, 0}).r, 0.5f);
  const std::vector<int8_t> normals = {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
  made.attribute("NORMAL", normals, "VEC3", i8, 4, true, 4);
  made.attribute("TEXCOORD_0", std::vector<uint16_t>{0, 65535, 65535, 65535, 65535, 0, 0, 0}, "VEC2", u16, 4,
                 true);
  EXPECT_TRUE(same_pixels(shown(made), floats));
  made.attribute("TEXCOORD_0", Bytes{0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0}, "VEC2", u8, 4,
                 true, 4);
  EXPECT_TRUE(same_pixels(shown(made), floats));
}

// KHR_mesh_quantization: positions in steps, which the node's matrix undoes.
TEST(OwnGeometry, QuantisedPositions) {
  GltfBuilder made = white_plate();
  made.root["extensionsUsed"] = made.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  // The left half: x from -1 to 0.
  const std::vector<uint16_t> shorts = {0, 0, 7, 0, 500, 0, 7, 0, 500, 1000, 7, 0, 0, 1000, 7, 0};
  made.attribute("POSITION", shorts, "VEC3", u16, 4, false, 8);
  made.node()["scale"] = {0.002, 0.002, 0.001};
  made.node()["translation"] = {-1, -1, 0};
  expect_quarters(shown(made), {white, black, white, black});
  const std::vector<int8_t> bytes = {-100, -100, 0, 0, 0, -100, 0, 0, 0, 100, 0, 0, -100, 100, 0, 0};
  made.attribute("POSITION", bytes, "VEC3", i8, 4, true, 4);
  made.node()["scale"] = {1.27, 1.27, 1};
  made.node()["translation"] = {0, 0, 0};
  expect_quarters(shown(made), {white, black, white, black});
}

// The upper two of four corners are moved down to the middle.
TEST(OwnGeometry, SparsePositionsReplaceThoseOfTheBase) {
  GltfBuilder made = white_plate();
  const int where = made.view(Bytes{2, 3}), what = made.view(bytes_of(Floats{1, 0, 0, -1, 0, 0}));
  const int positions = made.primitive()["attributes"]["POSITION"];
  made.root["accessors"][positions]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", where}, {"componentType", 5121}}},
      {"values", {{"bufferView", what}}}};
  expect_quarters(shown(made), {black, black, white, white});
}

TEST(OwnGeometry, InterleavedAttributesShowWhatSeparateOnesDo) {
  GltfBuilder made = lit_plate({1, 1, 1});
  material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_four_colors(made)}};
  add_light(made, {{"type", "directional"}, {"intensity", 2}});
  const Picture apart = shown(made);
  const int view = made.view(bytes_of(Floats{9, -1, -1, 0, 0, 0, 1, 0, 1,  //
                                             9, 1,  -1, 0, 0, 0, 1, 1, 1,  //
                                             9, 1,  1,  0, 0, 0, 1, 1, 0,  //
                                             9, -1, 1,  0, 0, 0, 1, 0, 0}),
                             36);
  const auto part = [&](const char* name, const char* type, int offset) {
    const int accessor = made.accessor(view, type, f32, 4);
    made.root["accessors"][accessor]["byteOffset"] = offset;
    made.primitive()["attributes"][name] = accessor;
  };
  part("POSITION", "VEC3", 4);
  part("NORMAL", "VEC3", 16);
  part("TEXCOORD_0", "VEC2", 28);
  EXPECT_TRUE(same_pixels(shown(made), apart));
}

TEST(OwnGeometry, DataUrisAndFilesAndGlbShowTheSame) {
  GltfBuilder made = white_plate();
  material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_four_colors(made)}};
  const Picture data_uri = shown(made);
  expect_quarters(data_uri, {red, green, blue, white});
  const ModelFolder folder;
  EXPECT_TRUE(same_pixels(shown(load_gltf(folder.write("made.glb", made.glb()))), data_uri));
  folder.write("of the plate.bin", made.bin);
  made.root["buffers"] = {{{"byteLength", made.bin.size()}, {"uri", "of%20the%20plate.bin"}}};
  EXPECT_TRUE(same_pixels(shown(load_gltf(folder.write("made.gltf", made.text()))), data_uri));
}

TEST(OwnGeometry, IndicesOfEveryWidthAndStripsAndFansShowTheSame) {
  GltfBuilder made = white_plate();
  const Picture shorts = shown(made);
  expect_quarters(shorts, {white, white, white, white});
  made.indices(Bytes{0, 1, 2, 0, 2, 3}, u8);
  EXPECT_TRUE(same_pixels(shown(made), shorts));
  made.indices(std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, u32);
  EXPECT_TRUE(same_pixels(shown(made), shorts));
  made.indices(Bytes{0, 1, 3, 2}, u8);
  made.primitive()["mode"] = 5;
  EXPECT_TRUE(same_pixels(shown(made), shorts));
  made.primitive().erase("indices");
  made.primitive()["mode"] = 6;
  EXPECT_TRUE(same_pixels(shown(made), shorts));
}

// With its weight of a half, the target moves the right edge from 1 to 0; the node's weights override the
// mesh's.
TEST(OwnGeometry, MorphTargetsAtTheirDefaultWeights) {
  GltfBuilder made = white_plate();
  const int move =
      made.accessor(made.view(bytes_of(Floats{0, 0, 0, -2, 0, 0, -2, 0, 0, 0, 0, 0})), "VEC3", f32, 4);
  made.primitive()["targets"] = {{{"POSITION", move}}};
  expect_quarters(shown(made), {white, white, white, white});
  made.root["meshes"][0]["weights"] = {0.5};
  expect_quarters(shown(made), {white, black, white, black});
  made.node()["weights"] = {0};
  expect_quarters(shown(made), {white, white, white, white});
}

// The lower corners belong to a joint that stays, the upper ones to its child, which moves down by 1; the
// node's own position is ignored.
TEST(OwnGeometry, ASkinStandsInItsRestPose) {
  GltfBuilder made = white_plate();
  made.attribute("JOINTS_0", Bytes{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", u8, 4);
  made.attribute("WEIGHTS_0", Floats{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", f32, 4);
  made.node()["skin"] = 0;
  made.node()["translation"] = {50, 0, 0};
  made.root["nodes"].push_back({{"children", {3}}});
  made.root["nodes"].push_back({{"translation", {0, -1, 0}}});
  made.root["scenes"][0]["nodes"].push_back(2);
  made.root["skins"] = {{{"joints", {2, 3}}}};
  expect_quarters(shown(made), {black, black, white, white});
}

// Two nodes share the plate at half its size, each in its parent's quarter.
TEST(OwnGeometry, NestedNodesAddUp) {
  GltfBuilder made = white_plate();
  made.root["nodes"][0] = {{"translation", {0.5, 0.5, 0}}, {"scale", {0.5, 0.5, 0.5}}, {"children", {2, 3}}};
  made.root["nodes"].push_back({{"mesh", 0}});
  made.root["nodes"].push_back({{"mesh", 0}, {"translation", {-2, -2, 0}}});
  expect_quarters(shown(made), {black, white, white, black});
}

TEST(OwnGeometry, OnlyTheDefaultSceneIsShown) {
  GltfBuilder made = white_plate();
  made.root["scenes"] = {{{"nodes", {0, 1, 2}}}, {{"nodes", {1, 2}}}};
  made.root["nodes"].push_back({{"mesh", 0}, {"translation", {-1, 0, 1}}});
  made.root["scene"] = 1;
  expect_quarters(shown(made), {white, black, white, black});
}

// A mirrored node reverses the winding. A plate seen from its front stays visible, at the mirrored position,
// and lit as before. Mirrored in depth it shows its back, which is culled unless it is double-sided.
TEST(OwnGeometry, NegativeScales) {
  GltfBuilder made = lit_plate({0.5f, 0.5f, 0.5f});
  add_light(made, {{"type", "directional"}, {"intensity", 2}});
  made.indices(std::vector<uint16_t>{0, 1, 3}, u16);  // without the upper right half
  const glm::dvec3 lower_left(-0.5, -0.5, 0), lower_right(0.5, -0.5, 0), upper_right(0.6, 0.5, 0);
  const auto scaled = [&](const json& scale) {
    made.node()["scale"] = scale;
    return shown(made);
  };
  const Picture plain = scaled({1, 1, 1}), across = scaled({-1, 1, 1}), turned = scaled({-1, -1, 1});
  const glm::vec3 lit = plain.at(lower_left);
  EXPECT_GT(lit.r, 0.1f);
  EXPECT_TRUE(plain.is_background(upper_right));
  EXPECT_EQ(across.at(lower_right), lit);
  EXPECT_TRUE(across.is_background({-0.6, 0.5, 0}));
  EXPECT_EQ(turned.at({0.5, 0.5, 0}), lit);
  EXPECT_TRUE(turned.is_background({-0.5, -0.6, 0}));
  EXPECT_TRUE(scaled({1, 1, -1}).is_background(lower_left));
  material_of(made)["doubleSided"] = true;
  EXPECT_EQ(scaled({1, 1, -1}).at(lower_left), lit);
  EXPECT_EQ(scaled({-1, 1, -1}).at(lower_right), lit);
}

json instanced_by(const json& attributes) {
  return {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
}

// The index of an instance attribute of floats.
int add_floats(GltfBuilder& made, const Floats& values, const char* type, size_t count) {
  return made.accessor(made.view(bytes_of(values)), type, f32, count);
}

// EXT_mesh_gpu_instancing: each instance covers a quarter, inside the node's own transform. The mesh itself
// is not drawn.
TEST(OwnGeometry, InstancesOfANodesMesh) {
  GltfBuilder made = white_plate();
  const int scale = add_floats(made, {0.5f, 0.5f, 1, 0.5f, 0.5f, 1, 0.5f, 0.5f, 1}, "VEC3", 3);
  const int places = add_floats(made, {-0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f, 0.5f, 0}, "VEC3", 3);
  made.node()["extensions"] = instanced_by({{"TRANSLATION", places}, {"SCALE", scale}});
  expect_quarters(shown(made), {white, white, black, white});
  made.node()["scale"] = {-1, -1, 1};
  expect_quarters(shown(made), {white, black, white, white});
  made.node()["scale"] = {0.5, 0.5, 1};  // half as wide: a quarter's middle is an edge of it
  made.node()["translation"] = {0.5, -0.5, 0};
  EXPECT_EQ(shown(made).at({0.25, -0.25, 0}), glm::vec3(1));
  EXPECT_EQ(shown(made).at({0.25, -0.75, 0}), glm::vec3(0));
  EXPECT_EQ(shown(made).at({-0.25, 0.25, 0}), glm::vec3(0));
}

// One instance: a quarter turn about z moves the plate from the right half to the upper half. Short and byte
// quaternions, normalised, and floats that are not of length 1.
TEST(OwnGeometry, ARotatedInstance) {
  GltfBuilder made = white_plate();
  made.attribute("POSITION", Floats{0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0}, "VEC3", f32, 4);
  const auto turned_by = [&](int rotation) {
    made.node()["extensions"] = instanced_by({{"ROTATION", rotation}});
    return shown(made);
  };
  expect_quarters(shown(made), {black, white, black, white});
  const int floats = add_floats(made, {0, 0, 3, 3}, "VEC4", 1);
  expect_quarters(turned_by(floats), {white, white, black, black});
  const int shorts =
      made.accessor(made.view(bytes_of(std::vector<int16_t>{0, 0, 23170, 23170})), "VEC4", i16, 1, true);
  expect_quarters(turned_by(shorts), {white, white, black, black});
  const int bytes =
      made.accessor(made.view(bytes_of(std::vector<int8_t>{0, 0, -90, 90})), "VEC4", i8, 1, true);
  expect_quarters(turned_by(bytes), {black, black, white, white});
}

// A mirrored instance shows its front, as a mirrored node does.
TEST(OwnGeometry, AnInstanceOfNegativeScale) {
  GltfBuilder made = lit_plate({0.5f, 0.5f, 0.5f});
  add_light(made, {{"type", "directional"}, {"intensity", 2}});
  made.attribute("POSITION", Floats{-1, -1, 0, 0, -1, 0, 0, 1, 0, -1, 1, 0}, "VEC3", f32, 4);
  const glm::vec3 lit = shown(made).at({-0.5, 0.5, 0});
  EXPECT_GT(lit.r, 0.1f);
  made.node()["extensions"] = instanced_by({{"SCALE", add_floats(made, {-1, 1, 1}, "VEC3", 1)}});
  const Picture mirrored = shown(made);
  EXPECT_EQ(mirrored.at({0.5, 0.5, 0}), lit);
  EXPECT_TRUE(mirrored.is_background({-0.5, 0.5, 0}));
  made.node()["extensions"] = instanced_by({{"SCALE", add_floats(made, {1, 1, -1}, "VEC3", 1)}});
  EXPECT_TRUE(shown(made).is_background({-0.5, 0.5, 0})) << "the back";
}

// 100 x 100 instances that cover a quarter of their cells: an instance shows at the pixels' centres in it.
TEST(OwnGeometry, TenThousandInstances) {
  GltfBuilder made = white_plate();
  Floats places, scale;
  const auto center = [](int i) { return (i + 0.5) / 50 - 1; };
  for (int i = 0; i < 10000; ++i) {
    places.insert(places.end(), {float(center(i % 100)), float(center(i / 100)), 0});
    scale.insert(scale.end(), {0.005f, 0.005f, 1});
  }
  made.node()["extensions"] = instanced_by({{"TRANSLATION", add_floats(made, places, "VEC3", 10000)},
                                            {"SCALE", add_floats(made, scale, "VEC3", 10000)}});
  const Picture picture = shown(made);
  const auto covered = [&](double at) {
    const double in_cell = (at + 1) * 50 - std::floor((at + 1) * 50);
    return std::abs(in_cell - 0.5) * 0.02 < 0.005;
  };
  size_t drawn = 0;
  for (int row = 0; row < own_size; ++row) {
    for (int column = 0; column < own_size; ++column) {
      const glm::dvec3 at = pixel_center(column, row);
      const bool expected = covered(at.x) && covered(at.y);
      drawn += expected;
      EXPECT_EQ(picture.image.at(column, row).r, expected ? 1.0f : 0.0f) << column << " " << row;
    }
  }
  EXPECT_GT(drawn, 500u);
}

}  // namespace
}  // namespace lightgrid
