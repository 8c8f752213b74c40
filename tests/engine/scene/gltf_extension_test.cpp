// Extensions and optional features: which are an error, and which one warning.
#include "support/gltf_builder.h"

#include <algorithm>

#include "scene/animation.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

size_t count_lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(GltfExtension, required_and_not_supported_is_an_error_that_names_it) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] =
      made.root["extensionsRequired"] = {"KHR_texture_transform", "KHR_texture_basisu"};
  made.root["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  made.root["images"] = {{{"uri", "a.ktx2"}}};
  EXPECT_EQ(made.refusal(),
            "made.gltf: requires the extension KHR_texture_basisu, which is not supported: convert its KTX2 "
            "images to "
            "PNG (gltf-transform ktxdecompress IN OUT)");
}

TEST(GltfExtension, a_required_image_format_is_left_out_where_each_texture_has_another_image) {
  GltfBuilder made = GltfBuilder::triangle();
  for (const std::string name : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
    made.root["extensionsUsed"] = made.root["extensionsRequired"] = {name};
    made.root["textures"] = {{{"source", 1}, {"extensions", {{name, {{"source", 0}}}}}}};
    made.root["images"] = {{{"uri", "a.other"}}, {{"uri", "a.png"}}};
    EXPECT_THAT(warnings_of([&] { made.load(); }), HasSubstr(name + " is not supported and left out"));
  }
}

TEST(GltfExtension, required_ones_that_change_no_picture_are_a_warning) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsRequired"] = {"EXT_structural_metadata",
                                     "EXT_mesh_features",
                                     "KHR_xmp_json_ld",
                                     "KHR_materials_variants",
                                     "MSFT_lod",
                                     "AGI_articulations",
                                     "CESIUM_primitive_outline",
                                     "FB_ngon_encoding",
                                     "MOZ_hubs_components",
                                     "MSFT_packing_occlusionRoughnessMetallic"};
  made.root["extensionsUsed"] = made.root["extensionsRequired"];
  const std::string warnings = warnings_of([&] { EXPECT_EQ(made.load().meshes.size(), 1u); });
  EXPECT_EQ(count_lines(warnings), 10u);
  EXPECT_THAT(warnings, HasSubstr("extension EXT_structural_metadata is not supported and left out"));
}

TEST(GltfExtension, the_supported_ones_may_be_required) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsRequired"] = {"KHR_lights_punctual",        "KHR_texture_transform",
                                     "KHR_materials_unlit",        "KHR_materials_emissive_strength",
                                     "KHR_materials_clearcoat",    "KHR_materials_ior",
                                     "KHR_materials_specular",     "EXT_mesh_gpu_instancing",
                                     "KHR_materials_transmission", "KHR_mesh_quantization",
                                     "KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                     "KHR_meshopt_compression",    "KHR_materials_pbrSpecularGlossiness"};
  made.root["extensionsUsed"] = made.root["extensionsRequired"];
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().meshes.size(), 1u); }), IsEmpty());
}

TEST(GltfExtension, optional_and_not_supported_is_one_line_each) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_materials_anisotropy", "KHR_materials_diffuse_transmission",
                                 "KHR_materials_dispersion", "KHR_materials_iridescence",
                                 "KHR_materials_sheen",      "KHR_materials_volume",
                                 "KHR_texture_basisu"};
  const std::string warnings = warnings_of([&] { made.load(); });
  EXPECT_EQ(count_lines(warnings), 7u);
  for (const std::string name : made.root["extensionsUsed"])
    EXPECT_THAT(warnings, HasSubstr("extension " + name + " is not supported and left out"));
}

TEST(GltfExtension, points_and_lines_are_one_line_per_kind) {
  GltfBuilder made = GltfBuilder::triangle();
  nlohmann::json points = made.primitive(), lines = made.primitive();
  points["mode"] = 0;
  lines["mode"] = 3;
  made.root["meshes"][0]["primitives"] = {made.primitive(), points, lines, points};
  const std::string warnings = warnings_of([&] { EXPECT_EQ(made.load().meshes.size(), 1u); });
  EXPECT_EQ(count_lines(warnings), 1u) << warnings;
  EXPECT_THAT(warnings, HasSubstr("points and lines are left out"));
}

// glTF forbids them; exporters write them for empty parts.
TEST(GltfExtension, accessors_without_elements_draw_nothing_with_a_warning) {
  const auto instances = [](GltfBuilder& made) {
    Scene scene;
    EXPECT_THAT(warnings_of([&] { scene = made.load(); }), HasSubstr("count is 0"));
    return scene.instances.size();
  };
  GltfBuilder positions = GltfBuilder::triangle();
  nlohmann::json empty = positions.primitive();
  empty["attributes"]["POSITION"] = positions.accessor(-1, "VEC3", f32, 0);
  positions.root["meshes"][0]["primitives"].push_back(empty);
  EXPECT_EQ(instances(positions), 1u);

  GltfBuilder indices = GltfBuilder::triangle();
  indices.primitive()["indices"] = indices.accessor(-1, "SCALAR", u16, 0);
  EXPECT_EQ(instances(indices), 0u);

  for (const char* name : {"NORMAL", "TEXCOORD_0", "COLOR_0", "JOINTS_0"}) {
    GltfBuilder attribute = GltfBuilder::triangle();
    attribute.primitive()["attributes"][name] = attribute.accessor(-1, "VEC3", f32, 0);
    attribute.primitive()["attributes"]["WEIGHTS_0"] = attribute.accessor(-1, "VEC4", f32, 3);
    EXPECT_EQ(instances(attribute), 1u) << name;
  }

  GltfBuilder target = GltfBuilder::triangle();
  target.primitive()["targets"] = {{{"POSITION", target.accessor(-1, "VEC3", f32, 0)}}};
  target.root["meshes"][0]["weights"] = {1};
  EXPECT_EQ(instances(target), 1u);

  GltfBuilder copies = GltfBuilder::triangle();
  copies.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  copies.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", copies.accessor(-1, "VEC3", f32, 0)}};
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = copies.load(); }), HasSubstr("has 0 instances"));
  EXPECT_EQ(scene.instances.size(), 0u);

  GltfBuilder skin = GltfBuilder::triangle();
  skin.attribute("JOINTS_0", std::vector<uint8_t>(12), "VEC4", u8, 3);
  skin.attribute("WEIGHTS_0", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", f32, 3);
  skin.root["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", skin.accessor(-1, "MAT4", f32, 0)}}};
  skin.node()["skin"] = 0;
  EXPECT_EQ(instances(skin), 1u);

  GltfBuilder keys = GltfBuilder::triangle();
  const int none = keys.accessor(-1, "SCALAR", f32, 0);
  const int times = keys.accessor(keys.view(bytes_of(std::vector<float>{0, 2})), "SCALAR", f32, 2);
  const int sizes = keys.accessor(-1, "VEC3", f32, 2);
  keys.root["animations"] = {
      {{"samplers", {{{"input", none}, {"output", none}}, {{"input", times}, {"output", sizes}}}},
       {"channels",
        {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
         {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
  EXPECT_EQ(instances(keys), 1u);
  EXPECT_EQ(duration_of(keys.load()), 2) << "the other channel is read";
}

TEST(GltfExtension, extras_are_ignored_whatever_they_hold) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["extras"] = {{"mesh", -7}, {"time", 1700000000000}, {"children", "none"}};
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().instances.size(), 1u); }), IsEmpty());
}

}  // namespace
}  // namespace lightgrid
