// Materials and their textures.
#include <algorithm>
#include <cmath>

#include "base/image.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string png_uri(int width, int height, uint8_t value = 200) {
  return "data:image/png;base64," +
         base64(encode_png(width, height, 3, Bytes(size_t(width) * height * 3, value)));
}

GltfBuilder with_material(const json& material) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.attribute("TEXCOORD_1", std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.root["materials"] = {material};
  made.primitive()["material"] = 0;
  made.root["images"] = {{{"uri", png_uri(2, 1)}, {"name", "pattern"}}, {{"uri", png_uri(1, 3)}}};
  made.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
  return made;
}

Material load_material(const json& material) { return with_material(material).load().materials.at(0); }

TEST(GltfMaterial, absent_fields_take_the_defaults_of_the_specification) {
  const Material material = load_material(json::object());
  EXPECT_EQ(material.base_color, glm::vec4(1));
  EXPECT_EQ(material.metallic, 1);
  EXPECT_EQ(material.roughness, 1);
  EXPECT_EQ(material.emissive, glm::vec3(0));
  EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(material.alpha_cutoff, 0.5f);
  EXPECT_FALSE(material.double_sided);
  EXPECT_FALSE(material.unlit);
  for (const TextureSlot& slot : {material.base_color_map, material.normal_map}) EXPECT_EQ(slot.texture, -1);
}

TEST(GltfMaterial, every_factor_and_slot_is_read) {
  const Material material =
      load_material({{"name", "m"},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                       {"metallicFactor", 0.25},
                       {"roughnessFactor", 0.75},
                       {"baseColorTexture", {{"index", 0}}},
                       {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
                     {"normalTexture", {{"index", 0}, {"scale", 2}}},
                     {"occlusionTexture", {{"index", 1}, {"strength", 0.5}}},
                     {"emissiveTexture", {{"index", 1}}},
                     {"emissiveFactor", {0.5, 0.25, 1}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}},
                     {"alphaMode", "MASK"},
                     {"alphaCutoff", 0.25},
                     {"doubleSided", true}});
  EXPECT_EQ(material.name, "m");
  EXPECT_EQ(material.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.25f);
  EXPECT_EQ(material.roughness, 0.75f);
  EXPECT_EQ(material.normal_scale, 2);
  EXPECT_EQ(material.occlusion_strength, 0.5f);
  EXPECT_EQ(material.emissive, glm::vec3(4, 2, 8));
  EXPECT_EQ(material.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.metallic_roughness_map.uv_set, 1);
  EXPECT_EQ(material.base_color_map.uv_set, 0);
}

TEST(GltfMaterial, an_image_used_as_colour_and_as_data_is_one_bitmap_and_two_textures) {
  const Scene scene = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                     {"normalTexture", {{"index", 0}}},
                                     {"occlusionTexture", {{"index", 0}}},
                                     {"emissiveTexture", {{"index", 1}}}})
                          .load();
  ASSERT_EQ(scene.bitmaps.size(), 2u);
  ASSERT_EQ(scene.textures.size(), 3u);
  const Material& material = scene.materials[0];
  EXPECT_TRUE(scene.textures[material.base_color_map.texture].srgb);
  EXPECT_TRUE(scene.textures[material.emissive_map.texture].srgb);
  EXPECT_FALSE(scene.textures[material.normal_map.texture].srgb);
  EXPECT_EQ(material.normal_map.texture, material.occlusion_map.texture);
  EXPECT_EQ(scene.textures[material.base_color_map.texture].bitmap, 0);
  EXPECT_EQ(scene.textures[material.normal_map.texture].bitmap, 0);
  EXPECT_EQ(scene.bitmaps[0].name, "pattern");
  EXPECT_EQ(scene.bitmaps[0].width, 2);
  EXPECT_EQ(scene.bitmaps[1].height, 3);
}

TEST(GltfMaterial, unlit_and_blend_are_read) {
  EXPECT_TRUE(load_material({{"extensions", {{"KHR_materials_unlit", json::object()}}}}).unlit);
  EXPECT_EQ(load_material({{"alphaMode", "BLEND"}}).alpha_mode, AlphaMode::blend);
}

TEST(GltfMaterial, a_clear_coat_is_read_with_its_maps) {
  const json transform = {{"KHR_texture_transform", {{"scale", {2, 3}}, {"texCoord", 1}}}};
  json coat = {{"clearcoatFactor", 0.5},
               {"clearcoatRoughnessFactor", 0.25},
               {"clearcoatTexture", {{"index", 0}, {"extensions", transform}}},
               {"clearcoatRoughnessTexture", {{"index", 0}, {"texCoord", 1}}},
               {"clearcoatNormalTexture", {{"index", 1}, {"scale", 0.75}}}};
  const auto load = [&] {
    return with_material({{"extensions", {{"KHR_materials_clearcoat", coat}}}}).load();
  };
  const Scene scene = load();
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.clearcoat, 0.5f);
  EXPECT_EQ(material.clearcoat_roughness, 0.25f);
  EXPECT_EQ(material.clearcoat_normal_scale, 0.75f);
  EXPECT_EQ(material.clearcoat_map.uv_set, 1);
  EXPECT_EQ(material.clearcoat_map.uv_from_vertex[0].x, 2);
  EXPECT_EQ(material.clearcoat_roughness_map.uv_set, 1);
  EXPECT_FALSE(material.clearcoat_roughness_map.transformed());
  EXPECT_EQ(material.clearcoat_map.texture, material.clearcoat_roughness_map.texture);
  EXPECT_NE(material.clearcoat_normal_map.texture, material.clearcoat_map.texture);
  EXPECT_FALSE(scene.textures[material.clearcoat_map.texture].srgb);
  EXPECT_FALSE(scene.textures[material.clearcoat_normal_map.texture].srgb);
  EXPECT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size()) << "of the coat's normal map";
  coat.erase("clearcoatFactor");
  const Scene none = load();
  EXPECT_EQ(none.materials[0].clearcoat, 0);
  EXPECT_TRUE(none.bitmaps.empty()) << "without a coat its maps are not decoded";
}

TEST(GltfMaterial, specular_reflectance_is_read_with_its_maps) {
  const json transform = {{"KHR_texture_transform", {{"scale", {2, 3}}, {"texCoord", 1}}}};
  json specular = {{"specularFactor", 0.5},
                   {"specularColorFactor", {0.25, 0.5, 4}},
                   {"specularTexture", {{"index", 0}, {"extensions", transform}}},
                   {"specularColorTexture", {{"index", 0}}}};
  const auto load = [&] {
    return with_material(
               {{"extensions", {{"KHR_materials_specular", specular}, {"KHR_materials_ior", {{"ior", 2}}}}}})
        .load();
  };
  const Scene scene = load();
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.ior, 2);
  EXPECT_EQ(material.specular, 0.5f);
  EXPECT_EQ(material.specular_color, glm::vec3(0.25f, 0.5f, 4));
  EXPECT_EQ(dielectric_f0(material), glm::vec3(glm::dvec3(0.25, 0.5, 4) / 9.0));
  EXPECT_EQ(material.specular_map.uv_set, 1);
  EXPECT_EQ(material.specular_map.uv_from_vertex[0].x, 2);
  EXPECT_FALSE(material.specular_color_map.transformed());
  EXPECT_FALSE(scene.textures[material.specular_map.texture].srgb);
  EXPECT_TRUE(scene.textures[material.specular_color_map.texture].srgb);
  specular["specularFactor"] = 0;
  EXPECT_TRUE(load().bitmaps.empty()) << "without reflection its maps are not decoded";
}

// A reflectance like glTF's default is none of its own: it compiles nothing.
TEST(GltfMaterial, specular_reflectance_like_the_default_is_none) {
  const auto specular_of = [](json material) { return has_specular(load_material(material)); };
  const json ior = {{"KHR_materials_ior", {{"ior", 1.5}}}}, ior_2 = {{"KHR_materials_ior", {{"ior", 2}}}};
  EXPECT_EQ(dielectric_f0({}), glm::vec3(0.04f));
  const json dielectric = {{"metallicFactor", 0}};
  EXPECT_FALSE(specular_of({{"pbrMetallicRoughness", dielectric}}));
  EXPECT_FALSE(specular_of({{"pbrMetallicRoughness", dielectric}, {"extensions", ior}}));
  EXPECT_FALSE(specular_of(
      {{"pbrMetallicRoughness", dielectric}, {"extensions", {{"KHR_materials_specular", json::object()}}}}));
  EXPECT_TRUE(specular_of({{"pbrMetallicRoughness", dielectric}, {"extensions", ior_2}}));
  EXPECT_FALSE(specular_of({{"extensions", ior_2}})) << "all metal";
  EXPECT_TRUE(specular_of(
      {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}, {"extensions", ior_2}}));
  json unlit = ior_2;
  unlit["KHR_materials_unlit"] = json::object();
  EXPECT_FALSE(specular_of({{"pbrMetallicRoughness", dielectric}, {"extensions", unlit}}));
}

TEST(GltfMaterial, a_model_is_read_from_the_extras) {
  const auto model_of = [](const json& model) {
    return load_material({{"extras", {{"lightgrid", model}, {"other", 1}}}}).model;
  };
  EXPECT_EQ(load_material({{"extras", {{"other", {{"model", "skin"}}}}}}).model, MaterialModel());
  EXPECT_EQ(load_material({{"extras", "lightgrid"}}).model, MaterialModel());
  EXPECT_EQ(model_of({{"model", "skin"}, {"subsurfaceColor", {0.5, 0.25, 1}}, {"rollOff", 0.75}}),
            (MaterialModel{.subsurface_color = {0.5f, 0.25f, 1}, .roll_off = 0.75f}));
  EXPECT_EQ(model_of({{"model", "skin"}}),
            (MaterialModel{.subsurface_color = {1, 0.2f, 0.2f}, .roll_off = 0.2f}));
  EXPECT_EQ(model_of({{"model", "minnaert"}, {"k", 0.5}}), (MaterialModel{.minnaert_k = 0.5f}));
}

TEST(GltfMaterial, impossible_models_are_refused_by_name) {
  const std::pair<json, const char*> cases[] = {
      {"skin", "material 0: extras.lightgrid is not an object"},
      {{{"model", 3}}, "material 0: extras.lightgrid.model is 3; it must be a string"},
      {{{"model", "wax"}}, "material 0: extras.lightgrid: model is \"wax\"; models are skin and minnaert"},
      {{{"model", "skin"}, {"rolloff", 0.1}},
       "extras.lightgrid.rolloff: unknown field; did you mean rollOff?"},
      {{{"model", "skin"}, {"rollOff", 1.5}}, "extras.lightgrid: rollOff is 1.5, outside 0 to 1"},
      {{{"model", "skin"}, {"rollOff", "much"}}, "rollOff is \"much\"; it must be a number"},
      {{{"model", "skin"}, {"subsurfaceColor", {1, 2}}},
       "subsurfaceColor is [1,2]; it must be three numbers"},
      {{{"model", "skin"}, {"subsurfaceColor", {1, 2, 1}}}, "subsurfaceColor is 2, outside 0 to 1"},
      {{{"model", "skin"}, {"k", 1}}, "k is given, but the model is skin"},
      {{{"model", "minnaert"}}, "k is missing"},
      {{{"model", "minnaert"}, {"k", 0}}, "k is 0; it is above 0 and at most 2"},
      {{{"model", "minnaert"}, {"k", 2.5}}, "k is 2.5; it is above 0"},
      {{{"model", "minnaert"}, {"k", 1}, {"rollOff", 0.1}}, "rollOff is given, but the model is minnaert"},
  };
  for (const auto& [model, message] : cases)
    EXPECT_THAT(with_material({{"extras", {{"lightgrid", model}}}}).refusal(), HasSubstr(message)) << model;
}

TEST(GltfMaterial, impossible_values_are_refused_by_name) {
  const std::pair<json, const char*> cases[] = {
      {{{"alphaMode", "GLASS"}}, "material 0: alphaMode is \"GLASS\""},
      {{{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}},
       "material 0: roughnessFactor is 1.5, outside 0 to 1"},
      {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, -1, 1}}}}}, "baseColorFactor is -1"},
      {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0}}}}}, "baseColorFactor"},
      {{{"emissiveFactor", {0, -2, 0}}}, "emissiveFactor is -2"},
      {{{"emissiveFactor", {1, 1, 1}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -1}}}}}},
       "emissiveStrength is -1"},
      {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 2}}}}}},
       "clearcoatFactor is 2, outside 0 to 1"},
      {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatRoughnessFactor", "much"}}}}}},
       "material 0: clearcoatRoughnessFactor is not a finite number"},
      {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 2}}}}}}}},
       "material 0: clearcoatTexture: texture is 2, but there are 2"},
      {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatNormalTexture", 3}}}}}},
       "material 0: clearcoatNormalTexture: is no texture with an index"},
      {{{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}},
       "material 0: ior is 0.5; it is 0, or 1 or more"},
      {{{"extensions", {{"KHR_materials_ior", {{"ior", -1}}}}}}, "material 0: ior is -1; it is 0"},
      {{{"extensions", {{"KHR_materials_ior", {{"ior", "glass"}}}}}},
       "material 0: ior is not a finite number"},
      {{{"extensions", {{"KHR_materials_specular", {{"specularFactor", 1.5}}}}}},
       "material 0: specularFactor is 1.5, outside 0 to 1"},
      {{{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {1, 1}}}}}}},
       "material 0: specularColorFactor is not three numbers"},
      {{{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {1, "red", 1}}}}}}},
       "material 0: specularColorFactor is not three numbers"},
      {{{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {1, -1, 1}}}}}}},
       "material 0: specularColorFactor is -1"},
      {{{"extensions", {{"KHR_materials_specular", {{"specularTexture", {{"index", 2}}}}}}}},
       "material 0: specularTexture: texture is 2, but there are 2"},
      {{{"normalTexture", {{"index", 2}}}}, "material 0: normalTexture: texture is 2, but there are 2"},
      {{{"normalTexture", {{"scale", 1}}}}, "'index' property is missing"},
  };
  for (const auto& [material, message] : cases)
    EXPECT_THAT(with_material(material).refusal(), HasSubstr(message)) << material;
}

TEST(GltfMaterial, any_two_uv_sets_are_read) {
  GltfBuilder made = with_material({{"normalTexture", {{"index", 0}, {"texCoord", 5}}},
                                    {"emissiveTexture", {{"index", 1}, {"texCoord", 2}}}});
  for (const int set : {0, 1, 2, 5})
    made.attribute(fmt::format("TEXCOORD_{}", set).c_str(), std::vector<float>(6, float(set)), "VEC2", f32,
                   3);
  const std::vector<float> moves(6, 0.5f);
  made.primitive()["targets"] = {{{"TEXCOORD_5", made.accessor(made.view(bytes_of(moves)), "VEC2", f32, 3)}}};
  made.root["meshes"][0]["weights"] = {1};
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), testing::IsEmpty());
  EXPECT_EQ(scene.materials[0].normal_map.uv_set, 1);
  EXPECT_EQ(scene.materials[0].emissive_map.uv_set, 0);
  EXPECT_EQ(scene.meshes[0].uv0, std::vector(3, glm::vec2(2)));
  EXPECT_EQ(scene.meshes[0].uv1, std::vector(3, glm::vec2(5.5f)));
  made.root["materials"][0].erase("emissiveTexture");
  scene = made.load();
  EXPECT_EQ(scene.materials[0].normal_map.uv_set, 0);
  EXPECT_EQ(scene.meshes[0].uv0, std::vector(3, glm::vec2(5.5f)));
  EXPECT_TRUE(scene.meshes[0].uv1.empty());
}

TEST(GltfMaterial, a_third_uv_set_of_one_material_is_left_out_with_a_warning) {
  GltfBuilder made = with_material({{"normalTexture", {{"index", 0}, {"texCoord", 1}}},
                                    {"occlusionTexture", {{"index", 0}, {"texCoord", 3}}},
                                    {"emissiveTexture", {{"index", 1}, {"texCoord", 2}}}});
  Scene scene;
  EXPECT_THAT(
      warnings_of([&] { scene = made.load(); }),
      HasSubstr("uses TEXCOORD_2 besides TEXCOORD_1 and _3; its textures of a third set are left out"));
  EXPECT_EQ(scene.materials[0].normal_map.uv_set, 0);
  EXPECT_EQ(scene.materials[0].occlusion_map.uv_set, 1);
  EXPECT_EQ(scene.materials[0].emissive_map.texture, -1);
  EXPECT_EQ(scene.bitmaps.size(), 1u);
}

TEST(GltfMaterial, a_texture_transform_scales_then_turns_then_moves) {
  const Material material = load_material({{"normalTexture",
                                            {{"index", 0},
                                             {"texCoord", 0},
                                             {"extensions",
                                              {{"KHR_texture_transform",
                                                {{"offset", {10, 20}},
                                                 {"rotation", 1.5707963267948966},
                                                 {"scale", {2, 3}},
                                                 {"texCoord", 1}}}}}}}});
  const TextureSlot& slot = material.normal_map;
  EXPECT_EQ(slot.uv_set, 1) << "the extension's texCoord replaces the other";
  EXPECT_TRUE(slot.transformed());
  const auto apply = [&](float u, float v) { return slot.uv_from_vertex * glm::vec3(u, v, 1); };
  // A counter-clockwise quarter turn with v pointing down: u to -v, v to u.
  EXPECT_LT(glm::length(apply(0, 0) - glm::vec2(10, 20)), 1e-5f);
  EXPECT_LT(glm::length(apply(1, 0) - glm::vec2(10, 18)), 1e-5f);
  EXPECT_LT(glm::length(apply(0, 1) - glm::vec2(13, 20)), 1e-5f);
}

TEST(GltfMaterial, samplers_are_read_and_their_values_checked) {
  GltfBuilder made = with_material({{"normalTexture", {{"index", 0}}}, {"occlusionTexture", {{"index", 1}}}});
  made.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"minFilter", 9728}, {"magFilter", 9728}}};
  made.root["textures"][0]["sampler"] = 0;
  const Scene scene = made.load();
  const Texture& set = scene.textures[scene.materials[0].normal_map.texture];
  EXPECT_EQ(set.wrap_u, Wrap::clamp);
  EXPECT_EQ(set.wrap_v, Wrap::mirror);
  EXPECT_EQ(set.min_filter, Filter::nearest);
  EXPECT_FALSE(set.mag_linear);
  const Texture& plain = scene.textures[scene.materials[0].occlusion_map.texture];
  EXPECT_EQ(plain.wrap_u, Wrap::repeat);
  EXPECT_EQ(plain.min_filter, Filter::linear_mipmap_linear);
  EXPECT_TRUE(plain.mag_linear);
  const std::pair<int, Filter> filters[] = {{9729, Filter::linear},
                                            {9984, Filter::nearest_mipmap_nearest},
                                            {9985, Filter::linear_mipmap_nearest},
                                            {9986, Filter::nearest_mipmap_linear},
                                            {9987, Filter::linear_mipmap_linear}};
  for (const auto& [value, filter] : filters) {
    made.root["samplers"][0]["minFilter"] = value;
    EXPECT_EQ(made.load().textures[0].min_filter, filter) << value;
  }
  for (const char* field : {"wrapS", "wrapT", "minFilter", "magFilter"}) {
    GltfBuilder broken = made;
    broken.root["samplers"][0][field] = 1234;
    EXPECT_THAT(broken.refusal(), HasSubstr(fmt::format("sampler 0: {} is 1234", field)));
  }
}

TEST(GltfMaterial, materials_that_no_mesh_uses_cost_no_image) {
  GltfBuilder made = with_material({{"normalTexture", {{"index", 0}}}});
  made.root["materials"].push_back({{"name", "plain"}});
  made.root["images"][0]["uri"] = "data:image/png;base64,AAAA";
  made.primitive()["material"] = 1;
  const Scene scene = made.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "plain");
  EXPECT_EQ(scene.meshes[0].material, 0);
  EXPECT_TRUE(scene.bitmaps.empty());
}

TEST(GltfMaterial, faults_of_unused_materials_and_images_do_not_matter) {
  GltfBuilder made = with_material({{"name", "plain"}});
  made.root["materials"].push_back(
      {{"alphaMode", "SOLID"}, {"pbrMetallicRoughness", {{"metallicFactor", 7}}}});
  made.root["materials"].push_back({{"emissiveTexture", {{"index", 0}}}});
  made.root["images"][0] = json::object();
  made.root["meshes"].push_back(made.root["meshes"][0]);  // no node has it
  made.root["meshes"][1]["primitives"][0]["material"] = 1;
  EXPECT_EQ(made.load().materials.at(0).name, "plain");
  made.primitive()["material"] = 1;
  EXPECT_THAT(made.refusal(), HasSubstr("material 1: metallicFactor is 7, outside 0 to 1"));
  made.primitive()["material"] = 2;
  EXPECT_THAT(made.broken_images(), HasSubstr("made.gltf: images[0] must have either a bufferView or a uri"));
}

// A thin pane passes what its two faces do not reflect at normal incidence: (1 - 0.04)^2 of the factor.
TEST(GltfMaterial, transmission_becomes_blending_with_a_warning) {
  const auto pane = [](const json& pbr, const json& extensions, const char* mode = "OPAQUE") {
    GltfBuilder made = GltfBuilder::triangle();
    made.root["materials"] = {
        {{"pbrMetallicRoughness", pbr}, {"extensions", extensions}, {"alphaMode", mode}}};
    made.primitive()["material"] = 0;
    Scene scene;
    EXPECT_THAT(warnings_of([&] { scene = made.load(); }),
                HasSubstr("KHR_materials_transmission is drawn as blending: without refraction"));
    return scene.materials.at(0);
  };
  const json clear = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
  const Material glass = pane({{"metallicFactor", 0}, {"baseColorFactor", {1, 1, 1, 0.25}}}, clear);
  EXPECT_EQ(glass.alpha_mode, AlphaMode::blend);
  EXPECT_NEAR(glass.base_color.a, 1 - 0.96 * 0.96, 1e-6) << "an opaque material's alpha is ignored";
  const Material half = pane({{"metallicFactor", 0}, {"baseColorFactor", {1, 0.5, 0, 0.25}}}, clear, "BLEND");
  EXPECT_NEAR(half.base_color.a, 0.25 * (1 - 0.5 * 0.96 * 0.96), 1e-6) << "tinted, and a quarter of it there";
  EXPECT_NEAR(pane({{"metallicFactor", 1}}, clear).base_color.a, 1, 1e-6) << "metal";
  json thick = clear;
  thick["KHR_materials_ior"] = {{"ior", 2}};
  EXPECT_NEAR(pane({{"metallicFactor", 0}}, thick).base_color.a, 1 - std::pow(8.0 / 9, 2), 1e-6);
}

}  // namespace
}  // namespace lightgrid
