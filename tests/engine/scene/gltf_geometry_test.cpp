// Accessors and primitives.
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Indices = std::vector<uint32_t>;

// Five corners of a strip, for the modes.
GltfBuilder five_points() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("POSITION", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", f32, 5);
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 5);
  return made;
}

TEST(GltfGeometry, a_primitive_without_indices_takes_vertices_in_order) {
  const Scene scene = GltfBuilder::triangle().load();
  EXPECT_EQ(scene.meshes.at(0).indices, (Indices{0, 1, 2}));
  EXPECT_EQ(scene.meshes[0].bounds.min, glm::vec3(0));
  EXPECT_EQ(scene.meshes[0].bounds.max, glm::vec3(1, 1, 0));
}

TEST(GltfGeometry, indices_of_every_width_are_read) {
  for (ComponentType type : {u8, u16, u32}) {
    GltfBuilder made = five_points();
    if (type == u8) made.indices(std::vector<uint8_t>{4, 3, 2}, type);
    if (type == u16) made.indices(std::vector<uint16_t>{4, 3, 2}, type);
    if (type == u32) made.indices(std::vector<uint32_t>{4, 3, 2}, type);
    EXPECT_EQ(made.load().meshes.at(0).indices, (Indices{4, 3, 2})) << type;
  }
}

TEST(GltfGeometry, strips_and_fans_keep_the_front_of_their_first_triangle) {
  GltfBuilder made = five_points();
  made.primitive()["mode"] = 5;
  EXPECT_EQ(made.load().meshes.at(0).indices, (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  made.primitive()["mode"] = 6;
  EXPECT_EQ(made.load().meshes.at(0).indices, (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfGeometry, corners_left_over_are_dropped_with_a_warning) {
  GltfBuilder made = five_points();
  const std::string warning = warnings_of([&] {
    EXPECT_EQ(made.load().meshes.at(0).indices, (Indices{0, 1, 2}));
  });
  EXPECT_THAT(warning, HasSubstr("5 indices are not whole triangles"));
}

TEST(GltfGeometry, integers_are_normalised_by_the_rule_of_the_specification) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<uint8_t>{0, 255, 0, 0, 51, 102, 0, 0, 153, 204, 0, 0}, "VEC2", u8,
                 3, true, 4);
  made.attribute("TEXCOORD_1", std::vector<uint16_t>{0, 65535, 13107, 26214, 39321, 52428}, "VEC2", u16, 3,
                 true);
  made.attribute("COLOR_0", std::vector<uint8_t>{255, 0, 51, 0, 51, 102, 153, 0, 0, 0, 0, 0}, "VEC3", u8, 3,
                 true, 4);
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_THAT(mesh.uv0, ElementsAre(glm::vec2(0, 1), glm::vec2(0.2f, 0.4f), glm::vec2(0.6f, 0.8f)));
  EXPECT_THAT(mesh.uv1, ElementsAre(glm::vec2(0, 1), glm::vec2(0.2f, 0.4f), glm::vec2(0.6f, 0.8f)));
  EXPECT_EQ(mesh.colors.at(0), glm::vec4(1, 0, 0.2f, 1)) << "three components: alpha is 1";
  EXPECT_EQ(mesh.colors.at(1), glm::vec4(0.2f, 0.4f, 0.6f, 1));
}

TEST(GltfGeometry, quantised_positions_and_signed_normals_are_read) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("POSITION", std::vector<int16_t>{-5, 0, 7, 0, 300, 0, 0, 0, 0, 300, 0, 0}, "VEC3", i16, 3,
                 false, 8);
  made.attribute("NORMAL", std::vector<int8_t>{0, 0, 127, 0, 0, -128, 0, 0, -127, 0, 0, 0}, "VEC3", i8, 3,
                 true, 4);
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(-5, 0, 7), glm::vec3(300, 0, 0), glm::vec3(0, 300, 0)));
  EXPECT_THAT(mesh.normals, ElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, -1, 0), glm::vec3(-1, 0, 0)))
      << "-128 and -127 are both -1";
}

TEST(GltfGeometry, colours_are_clamped_and_of_all_types) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("COLOR_0", std::vector<float>{2, -1, 0.5f, 0.25f, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", f32, 3);
  EXPECT_EQ(made.load().meshes.at(0).colors.at(0), glm::vec4(1, 0, 0.5f, 0.25f));
  made.attribute("COLOR_0", std::vector<uint16_t>{0, 65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", u16, 3,
                 true);
  EXPECT_EQ(made.load().meshes.at(0).colors.at(0), glm::vec4(0, 1, 0, 0.2f));
}

TEST(GltfGeometry, interleaved_attributes_share_a_view) {
  GltfBuilder made = GltfBuilder::triangle();
  const int view =
      made.view(bytes_of(std::vector<float>{0, 0, 0, 0.5f, 0.25f, 2, 0, 0, 1, 0, 0, 2, 0, 0, 1}), 20);
  made.primitive()["attributes"]["POSITION"] = made.accessor(view, "VEC3", f32, 3);
  const int uv = made.accessor(view, "VEC2", f32, 3);
  made.root["accessors"][uv]["byteOffset"] = 12;
  made.primitive()["attributes"]["TEXCOORD_0"] = uv;
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_THAT(mesh.positions, ElementsAre(glm::vec3(0), glm::vec3(2, 0, 0), glm::vec3(0, 2, 0)));
  EXPECT_THAT(mesh.uv0, ElementsAre(glm::vec2(0.5f, 0.25f), glm::vec2(1, 0), glm::vec2(0, 1)));
}

TEST(GltfGeometry, sparse_elements_replace_those_of_the_base_or_zeros) {
  for (bool with_base : {true, false}) {
    GltfBuilder made = GltfBuilder::triangle();
    nlohmann::json& accessor = made.root["accessors"][0];
    const int where = made.view(bytes_of(std::vector<uint8_t>{1, 2}));
    const int what = made.view(bytes_of(std::vector<float>{5, 0, 0, 0, 6, 0}));
    if (!with_base) accessor.erase("bufferView");
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                          {"values", {{"bufferView", what}}}};
    EXPECT_THAT(made.load().meshes.at(0).positions,
                ElementsAre(glm::vec3(0), glm::vec3(5, 0, 0), glm::vec3(0, 6, 0)));
    accessor["sparse"]["count"] = 0;
    EXPECT_EQ(made.load().meshes.at(0).positions[1], with_base ? glm::vec3(1, 0, 0) : glm::vec3(0));
    accessor["sparse"]["count"] = 4;
    EXPECT_THAT(made.refusal(), HasSubstr("POSITION: sparse.count is 4 of 3"));
    accessor["sparse"]["count"] = 3'000'000'000;  // above 2^31: was printed as -1294967296
    EXPECT_THAT(made.refusal(),
                HasSubstr("POSITION: sparse.count is not a number from 1 to the accessor's count"));
    accessor["sparse"]["count"] = 2;
    std::copy_n("\2\1", 2, made.bin.begin() + made.root["bufferViews"][where]["byteOffset"].get<int>());
    EXPECT_THAT(made.refusal(), HasSubstr("sparse indices do not increase"));
    std::copy_n("\1\3", 2, made.bin.begin() + made.root["bufferViews"][where]["byteOffset"].get<int>());
    EXPECT_THAT(made.refusal(), HasSubstr("sparse index 3 of 3"));
  }
}

TEST(GltfGeometry, without_normals_vertices_are_unshared_and_flat) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("POSITION", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", f32, 4);
  made.attribute("TEXCOORD_0", std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}, "VEC2", f32, 4);
  made.indices(std::vector<uint16_t>{0, 1, 2, 0, 3, 1, 0, 0, 1}, u16);
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 9u);
  EXPECT_EQ(mesh.uv0.size(), 9u);
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(mesh.positions[4], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.uv0[4], glm::vec2(1, 1));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.normals[i], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[3 + i], glm::vec3(0, 1, 0)) << "z cross x";
    EXPECT_EQ(mesh.normals[6 + i], glm::vec3(0, 0, 1)) << "no area: +z";
  }
}

TEST(GltfGeometry, a_normal_of_no_length_is_taken_from_the_triangles_around) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", std::vector<float>{0, 0, 0, 0, 3, 4, 0, 0, 1}, "VEC3", f32, 3);
  EXPECT_THAT(made.load().meshes.at(0).normals,
              ElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, 0.6f, 0.8f), glm::vec3(0, 0, 1)));
}

GltfBuilder with_normal_map(const std::vector<float>& uv) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  if (!uv.empty()) made.attribute("TEXCOORD_0", uv, "VEC2", f32, 3);
  static const std::string pixel =
      "data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+"
      "M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";
  made.root["images"] = {{{"uri", pixel}}};
  made.root["textures"] = {{{"source", 0}}};
  made.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  made.primitive()["material"] = 0;
  return made;
}

TEST(GltfGeometry, missing_tangents_run_along_u_with_the_handedness_of_the_image) {
  // u along x, v against y, as an image lies upright: cross(z, x) = y is up in the image, so w is 1.
  EXPECT_EQ(with_normal_map({0, 1, 1, 1, 0, 0}).load().meshes.at(0).tangents.at(0), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(with_normal_map({1, 1, 0, 1, 1, 0}).load().meshes.at(0).tangents.at(0), glm::vec4(-1, 0, 0, -1))
      << "mirrored in u";
  EXPECT_EQ(with_normal_map({0, 0, 0, 1, 1, 0}).load().meshes.at(0).tangents.at(0), glm::vec4(0, 1, 0, 1))
      << "u along y, v along x: up in the image is -x = cross(z, y)";
}

TEST(GltfGeometry, tangents_without_usable_uvs_are_any_unit_vector_across_the_normal) {
  for (const std::vector<float>& uv :
       {std::vector<float>{}, std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}}) {
    const Mesh mesh = with_normal_map(uv).load().meshes.at(0);
    ASSERT_EQ(mesh.tangents.size(), 3u);
    EXPECT_FLOAT_EQ(glm::length(glm::vec3(mesh.tangents[0])), 1);
    EXPECT_EQ(mesh.tangents[0].z, 0);
  }
}

TEST(GltfGeometry, tangents_of_the_file_are_kept_only_where_a_normal_map_needs_them) {
  GltfBuilder made = with_normal_map({0, 0, 1, 0, 0, 1});
  made.attribute("TANGENT", std::vector<float>{0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4", f32, 3);
  EXPECT_EQ(made.load().meshes.at(0).tangents.at(0), glm::vec4(0, 1, 0, -1));
  made.primitive().erase("material");
  EXPECT_TRUE(made.load().meshes.at(0).tangents.empty());
}

TEST(GltfGeometry, a_primitive_without_a_material_gets_the_default_one) {
  const Scene scene = GltfBuilder::triangle().load();
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1));
  EXPECT_EQ(scene.materials[0].metallic, 1);
  EXPECT_EQ(scene.meshes[0].material, 0);
}

TEST(GltfGeometry, values_that_are_not_finite_are_named) {
  for (const char* name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
    GltfBuilder made = GltfBuilder::triangle();
    const bool pair = std::string(name) == "TEXCOORD_0";
    std::vector<float> values(pair ? 6 : 9, 1);
    values[pair ? 4 : 7] = NAN;
    made.attribute(name, values, pair ? "VEC2" : "VEC3", f32, 3);
    EXPECT_THAT(made.refusal(), HasSubstr(fmt::format("mesh 0 primitive 0: {}: element 2 is nan", name)));
  }
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("POSITION", std::vector<float>{0, INFINITY, 0, 0, 0, 0, 0, 0, 0}, "VEC3", f32, 3);
  EXPECT_THAT(made.refusal(), HasSubstr("POSITION: element 0 is inf"));
}

TEST(GltfGeometry, counts_and_offsets_that_leave_their_view_are_refused_before_allocation) {
  for (uint64_t count : {uint64_t(4), uint64_t(1) << 31, uint64_t(1) << 62, ~uint64_t(0)}) {
    GltfBuilder made = GltfBuilder::triangle();
    made.root["accessors"][0]["count"] = count;
    EXPECT_THAT(made.refusal(),
                testing::AnyOf(HasSubstr("do not fit a view of 36 bytes"), HasSubstr("pass the limit")))
        << count;
  }
  for (uint64_t offset : {uint64_t(4), uint64_t(37), ~uint64_t(0) - 3}) {
    GltfBuilder made = GltfBuilder::triangle();
    made.root["accessors"][0]["byteOffset"] = offset;
    EXPECT_THAT(made.refusal(), HasSubstr("do not fit a view of 36 bytes")) << offset;
  }
  for (const char* field : {"byteOffset", "byteLength"}) {
    GltfBuilder made = GltfBuilder::triangle();
    made.root["bufferViews"][0][field] = ~uint64_t(0);
    EXPECT_THAT(made.refusal(), HasSubstr("do not fit buffer 0 of 36")) << field;
  }
  GltfBuilder made = GltfBuilder::triangle();
  made.root["bufferViews"][0]["byteStride"] = 8;
  EXPECT_THAT(made.refusal(), HasSubstr("byteStride is 8, but an element has 12 bytes"));
}

TEST(GltfGeometry, accessors_of_the_wrong_kind_are_refused) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<float>(9), "VEC3", f32, 3);
  EXPECT_THAT(made.refusal(), HasSubstr("TEXCOORD_0: has 3 components instead of 2"));
  made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<float>(4), "VEC2", f32, 2);
  EXPECT_THAT(made.refusal(), HasSubstr("TEXCOORD_0: has 2 elements, but there are 3 vertices"));
  made = GltfBuilder::triangle();
  made.root["accessors"][0]["componentType"] = 5130;
  EXPECT_THAT(made.refusal(), HasSubstr("componentType is 5130"));
  made = GltfBuilder::triangle();
  made.indices(std::vector<float>{0, 1, 2}, f32);
  EXPECT_THAT(made.refusal(), HasSubstr("indices have componentType 5126"));
}

TEST(GltfGeometry, an_index_past_the_vertices_is_refused) {
  GltfBuilder made = GltfBuilder::triangle();
  made.indices(std::vector<uint16_t>{0, 1, 3}, u16);
  EXPECT_THAT(made.refusal(), HasSubstr("indices: 3 is past the last of 3 vertices"));
}

TEST(GltfGeometry, the_vertex_limit_counts_meshes_made_for_flat_normals) {
  GltfBuilder made = GltfBuilder::triangle();
  EXPECT_EQ(made.load({.max_vertices = 3}).meshes.size(), 1u);
  EXPECT_THAT(made.refusal({.max_vertices = 2}), HasSubstr("pass the limit of 2 vertices"));
  made.root["meshes"][0]["primitives"] = {made.primitive(), made.primitive()};
  EXPECT_THAT(made.refusal({.max_vertices = 5}), HasSubstr("pass the limit of 5 vertices"));
  made = GltfBuilder::triangle();
  made.indices(std::vector<uint8_t>{0, 1, 2, 0, 1, 2}, u8);
  EXPECT_THAT(made.refusal({.max_vertices = 5}), HasSubstr("pass the limit of 5 vertices"));
}

TEST(GltfGeometry, a_view_that_is_not_aligned_is_read_with_a_warning) {
  GltfBuilder made = GltfBuilder::triangle();
  made.bin.insert(made.bin.begin(), 0);
  made.root["bufferViews"][0]["byteOffset"] = 1;
  const std::string warning =
      warnings_of([&] { EXPECT_EQ(made.load().meshes.at(0).positions[1], glm::vec3(1, 0, 0)); });
  EXPECT_THAT(warning, HasSubstr("not aligned"));
}

}  // namespace
}  // namespace lightgrid
