// KHR_draco_mesh_compression and EXT_meshopt_compression, written by the libraries' own encoders.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A quad of two triangles.
const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<uint8_t> uvs = {0, 0, 255, 0, 255, 255, 0, 255};
const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};

template <typename T>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, int components,
                  draco::DataType data_type, bool normalized, const std::vector<T>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, static_cast<int8_t>(components), data_type, normalized,
                 sizeof(T) * components, 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<uint32_t>(values.size() / components));
  for (uint32_t i = 0; i < values.size() / components; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * components]);
  return static_cast<int>(mesh.attribute(id)->unique_id());
}

// The sequential method keeps the order of vertices. `draco_normalized`: whether Draco's own flag is set, on
// which writers disagree.
GltfBuilder draco_quad(bool draco_normalized = false, int method = draco::MESH_SEQUENTIAL_ENCODING) {
  draco::Mesh mesh;
  mesh.set_num_points(4);
  for (int i = 0; i < 2; ++i)
    mesh.AddFace({draco::PointIndex(indices[i * 3]), draco::PointIndex(indices[i * 3 + 1]),
                  draco::PointIndex(indices[i * 3 + 2])});
  json ids;
  ids["POSITION"] =
      add_attribute(mesh, draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, false, positions);
  ids["NORMAL"] =
      add_attribute(mesh, draco::GeometryAttribute::GENERIC, 3, draco::DT_FLOAT32, false, normals);
  ids["TEXCOORD_0"] =
      add_attribute(mesh, draco::GeometryAttribute::GENERIC, 2, draco::DT_UINT8, draco_normalized, uvs);
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer encoded;
  EXPECT_TRUE(encoder.EncodeToBuffer(&encoded).ok());

  GltfBuilder made = GltfBuilder::triangle();
  made.bin.clear();
  made.root["bufferViews"] = made.root["accessors"] = json::array();
  const int view = made.view(Bytes(encoded.data(), encoded.data() + encoded.size()));
  made.primitive() = {
      {"attributes",
       {{"POSITION", made.accessor(-1, "VEC3", f32, 4)},
        {"NORMAL", made.accessor(-1, "VEC3", f32, 4)},
        {"TEXCOORD_0", made.accessor(-1, "VEC2", u8, 4, true)}}},
      {"indices", made.accessor(-1, "SCALAR", u16, 6)},
      {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", ids}}}}}};
  made.root["extensionsUsed"] = made.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return made;
}

void expect_quad(const Mesh& mesh) {
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.normals, std::vector<glm::vec3>(4, {0, 0, 1}));
  EXPECT_EQ(mesh.uv0, (std::vector<glm::vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(mesh.indices, indices);
}

TEST(GltfDraco, a_compressed_primitive_equals_the_plain_one) {
  expect_quad(draco_quad().load().meshes.at(0));
  expect_quad(draco_quad(true).load().meshes.at(0));
}

TEST(GltfDraco, vertices_in_another_order_still_belong_together) {
  const Mesh mesh = draco_quad(false, draco::MESH_EDGEBREAKER_ENCODING).load().meshes.at(0);
  ASSERT_EQ(mesh.indices.size(), 6u);
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.bounds.max, glm::vec3(1, 1, 0));
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(mesh.uv0[i], glm::vec2(mesh.positions[i])) << "as in the quad";
  float area = 0;
  for (size_t i = 0; i < 6; i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]];
    area +=
        glm::cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a).z / 2;
  }
  EXPECT_EQ(area, 1) << "both triangles, front towards z";
}

TEST(GltfDraco, broken_data_and_wrong_indices_are_refused) {
  GltfBuilder made = draco_quad();
  made.bin[3] = 'x';
  EXPECT_THAT(made.refusal(), HasSubstr("mesh 0 primitive 0: KHR_draco_mesh_compression: "));
  made = draco_quad();
  json& extension = made.primitive()["extensions"]["KHR_draco_mesh_compression"];
  extension["attributes"]["POSITION"] = 77;
  EXPECT_THAT(made.refusal(), HasSubstr("has no attribute 77 for POSITION"));
  extension["attributes"] = {{"TANGENT", 0}};
  EXPECT_THAT(made.refusal(), HasSubstr("TANGENT is not an attribute of the primitive"));
  extension["bufferView"] = 5;
  EXPECT_THAT(made.refusal(), HasSubstr("bufferView is 5, but there are 1"));
  EXPECT_THAT(draco_quad().refusal({.max_vertices = 3}),
              HasSubstr("has 4 vertices and 2 triangles; at most 3 are read"));
}

TEST(GltfDraco, every_cut_and_many_changed_bytes_end_in_a_scene_or_an_input_error) {
  const GltfBuilder whole = draco_quad();
  for (size_t i = 0; i < whole.bin.size(); ++i) {
    GltfBuilder made = whole;
    made.bin[i] ^= 0x55;
    try {
      made.load();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    }
    made = whole;
    made.bin.resize(i + 1);
    made.root["bufferViews"][0]["byteLength"] = i + 1;
    if (i + 1 < whole.bin.size()) made.refusal();
  }
}

// Replaces the view's bytes by compressed ones; its buffer becomes the fallback, buffer 1 holds the
// compressed.
struct Meshopt {
  GltfBuilder made = GltfBuilder::triangle();
  Bytes packed;

  Meshopt() {
    made.bin.clear();
    made.root["bufferViews"] = made.root["accessors"] = json::array();
    made.root["extensionsUsed"] = made.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  }

  int view(const Bytes& encoded, const char* mode, size_t count, size_t stride, const char* filter = "NONE") {
    const bool attributes = std::string(mode) == "ATTRIBUTES";
    json view = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", count * stride}};
    if (attributes) view["byteStride"] = stride;
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 1},
                                                     {"byteOffset", packed.size()},
                                                     {"byteLength", encoded.size()},
                                                     {"mode", mode},
                                                     {"count", count},
                                                     {"byteStride", stride},
                                                     {"filter", filter}};
    packed.insert(packed.end(), encoded.begin(), encoded.end());
    made.root["bufferViews"].push_back(view);
    return static_cast<int>(made.root["bufferViews"].size()) - 1;
  }

  GltfBuilder& finish() {
    made.root["buffers"] = {
        {{"byteLength", 100000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}},
        {{"byteLength", packed.size()}, {"uri", "data:;base64," + base64(packed)}}};
    return made;
  }

  json& extension(int view) {
    return made.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
  }
};

template <typename T>
Bytes encode_vertices(const std::vector<T>& values, size_t count) {
  const size_t stride = values.size() * sizeof(T) / count;
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return out;
}

Meshopt meshopt_quad(bool sequence = false) {
  Meshopt out;
  Bytes packed_indices(meshopt_encodeIndexBufferBound(6, 4) + meshopt_encodeIndexSequenceBound(6, 4));
  packed_indices.resize(
      sequence ? meshopt_encodeIndexSequence(packed_indices.data(), packed_indices.size(), indices.data(), 6)
               : meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(), indices.data(), 6));
  std::vector<uint8_t> padded_uvs;
  for (int i = 0; i < 4; ++i) padded_uvs.insert(padded_uvs.end(), {uvs[i * 2], uvs[i * 2 + 1], 0, 0});
  json& attributes = out.made.primitive()["attributes"];
  attributes["POSITION"] =
      out.made.accessor(out.view(encode_vertices(positions, 4), "ATTRIBUTES", 4, 12), "VEC3", f32, 4);
  attributes["NORMAL"] =
      out.made.accessor(out.view(encode_vertices(normals, 4), "ATTRIBUTES", 4, 12), "VEC3", f32, 4);
  attributes["TEXCOORD_0"] =
      out.made.accessor(out.view(encode_vertices(padded_uvs, 4), "ATTRIBUTES", 4, 4), "VEC2", u8, 4, true);
  out.made.primitive()["indices"] =
      out.made.accessor(out.view(packed_indices, sequence ? "INDICES" : "TRIANGLES", 6, 4), "SCALAR", u32, 6);
  return out;
}

TEST(GltfMeshopt, compressed_views_over_a_fallback_buffer_equal_the_plain_ones) {
  expect_quad(meshopt_quad().finish().load().meshes.at(0));
  expect_quad(meshopt_quad(true).finish().load().meshes.at(0));
}

// Replaces the extension's name wherever it is.
GltfBuilder under_khr_name(GltfBuilder made) {
  std::string text = made.root.dump();
  for (size_t at = 0; (at = text.find("EXT_meshopt", at)) != std::string::npos;) text.replace(at, 3, "KHR");
  made.root = json::parse(text);
  return made;
}

TEST(GltfMeshopt, streams_of_version_0_have_the_khr_name_too) {
  const GltfBuilder made = under_khr_name(meshopt_quad().finish());
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), testing::IsEmpty());
  expect_quad(scene.meshes.at(0));
}

TEST(GltfMeshopt, a_stream_of_a_later_version_is_refused_by_its_version) {
  Meshopt quad = meshopt_quad();
  ASSERT_EQ(quad.packed[0], 0xa0);
  quad.packed[0] = 0xa1;
  EXPECT_THAT(under_khr_name(quad.finish()).refusal(),
              HasSubstr("the stream has version 1, but the installed"));
}

TEST(GltfMeshopt, a_fallback_buffer_is_not_fetched) {
  Meshopt quad = meshopt_quad();
  quad.finish().root["buffers"][0]["uri"] = "absent.bin";
  expect_quad(quad.made.load().meshes.at(0));
}

TEST(GltfMeshopt, a_plain_view_of_a_fallback_buffer_without_bytes_is_refused) {
  Meshopt quad = meshopt_quad();
  quad.finish().root["bufferViews"][0].erase("extensions");
  EXPECT_THAT(quad.made.refusal(), HasSubstr("POSITION: buffer 0 has no bytes"));
}

TEST(GltfMeshopt, filters_are_undone) {
  Meshopt quad = meshopt_quad();
  const std::vector<float> up = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  Bytes octahedral(16);
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, up.data());
  const int oct = quad.view(encode_vertices(octahedral, 4), "ATTRIBUTES", 4, 4, "OCTAHEDRAL");
  quad.made.primitive()["attributes"]["NORMAL"] = quad.made.accessor(oct, "VEC3", i8, 4, true);
  Bytes exponential(48);
#if MESHOPTIMIZER_VERSION < 200
  meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, positions.data());
#else
  meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, positions.data(), meshopt_EncodeExpSharedVector);
#endif
  const int exp = quad.view(encode_vertices(exponential, 4), "ATTRIBUTES", 4, 12, "EXPONENTIAL");
  quad.made.primitive()["attributes"]["POSITION"] = quad.made.accessor(exp, "VEC3", f32, 4);
  expect_quad(quad.finish().load().meshes.at(0));
}

TEST(GltfMeshopt, wrong_fields_and_broken_data_are_refused) {
  const std::tuple<const char*, json, const char*> cases[] = {
      {"mode", "POINTS", "mode is \"POINTS\""},
      {"byteStride", 3, "byteStride is 3 for mode ATTRIBUTES"},
      {"byteStride", 260, "byteStride is 260 for mode ATTRIBUTES"},
      {"byteStride", 0, "byteStride is 0"},
      {"count", 5, "count is 5 of stride 12, but the view has 48 bytes"},
      {"count", 0, "count is 0 of stride 12"},
      {"filter", "QUATERNION", "filter is \"QUATERNION\" for stride 12"},
      {"buffer", 9, "buffer is 9, but there are 2"},
      {"byteLength", 1000000, "do not fit buffer 1"},
      {"byteLength", 10, "compressed data is broken"},
  };
  for (const auto& [field, value, message] : cases) {
    Meshopt quad = meshopt_quad();
    quad.extension(0)[field] = value;
    EXPECT_THAT(quad.finish().refusal(), HasSubstr(message)) << field << " " << value;
  }
}

TEST(GltfMeshopt, a_count_that_no_data_could_hold_is_refused_before_allocation) {
  Meshopt quad = meshopt_quad();
  quad.extension(0)["count"] = 100000000;
  quad.made.root["bufferViews"][0]["byteLength"] = 1200000000;
  EXPECT_THAT(quad.finish().refusal(), HasSubstr("count is 100000000 of stride 12, too many for"));
}

TEST(GltfMeshopt, many_changed_bytes_end_in_a_scene_or_an_input_error) {
  const Meshopt whole = meshopt_quad();
  for (size_t i = 0; i < whole.packed.size(); ++i) {
    Meshopt quad = whole;
    quad.packed[i] ^= 0x55;
    try {
      quad.finish().load();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    }
  }
}

}  // namespace
}  // namespace lightgrid
