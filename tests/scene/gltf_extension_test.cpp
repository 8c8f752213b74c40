// Extensions and optional features: which are an error, and which one warning.
#include "support/gltf_builder.h"

#include <algorithm>

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

TEST(GltfExtension, required_basisu_is_read_where_each_texture_has_another_image) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = made.root["extensionsRequired"] = {"KHR_texture_basisu"};
  made.root["textures"] = {{{"source", 1}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  made.root["images"] = {{{"uri", "a.ktx2"}}, {{"uri", "a.png"}}};
  EXPECT_THAT(warnings_of([&] { made.load(); }),
              HasSubstr("KHR_texture_basisu is not supported and left out"));
}

TEST(GltfExtension, the_supported_ones_may_be_required) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsRequired"] = {"KHR_lights_punctual",        "KHR_texture_transform",
                                     "KHR_materials_unlit",        "KHR_materials_emissive_strength",
                                     "KHR_materials_clearcoat",    "KHR_materials_ior",
                                     "KHR_materials_specular",     "EXT_mesh_gpu_instancing",
                                     "KHR_materials_transmission", "KHR_mesh_quantization",
                                     "KHR_draco_mesh_compression", "EXT_meshopt_compression"};
  made.root["extensionsUsed"] = made.root["extensionsRequired"];
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().meshes.size(), 1u); }), IsEmpty());
}

TEST(GltfExtension, optional_and_not_supported_is_one_line_each) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_materials_anisotropy",
                                 "KHR_materials_diffuse_transmission",
                                 "KHR_materials_dispersion",
                                 "KHR_materials_iridescence",
                                 "KHR_materials_pbrSpecularGlossiness",
                                 "KHR_materials_sheen",
                                 "KHR_materials_volume",
                                 "KHR_texture_basisu"};
  const std::string warnings = warnings_of([&] { made.load(); });
  EXPECT_EQ(count_lines(warnings), 8u);
  for (const std::string name : made.root["extensionsUsed"])
    EXPECT_THAT(warnings, HasSubstr("extension " + name + " is not supported and left out"));
}

TEST(GltfExtension, points_and_lines_are_one_line_per_kind) {
  GltfBuilder made = GltfBuilder::triangle();
  nlohmann::json points = made.primitive(), lines = made.primitive();
  points["mode"] = 0, lines["mode"] = 3;
  made.root["meshes"][0]["primitives"] = {made.primitive(), points, lines, points};
  const std::string warnings = warnings_of([&] { EXPECT_EQ(made.load().meshes.size(), 1u); });
  EXPECT_EQ(count_lines(warnings), 1u) << warnings;
  EXPECT_THAT(warnings, HasSubstr("points and lines are left out"));
}

TEST(GltfExtension, extras_are_ignored_whatever_they_hold) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["extras"] = {{"mesh", -7}, {"time", 1700000000000}, {"children", "none"}};
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().instances.size(), 1u); }), IsEmpty());
}

}  // namespace
}  // namespace lightgrid
