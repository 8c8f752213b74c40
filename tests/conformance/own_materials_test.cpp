// Materials from a file to the picture, worked out by hand.
#include "conformance/own_model.h"

namespace lightgrid {
using namespace lab;
namespace {

using nlohmann::json;

// pi lux along the plate's normal and the view: appendix B of glTF 2.0 with N = L = V = H. With alpha =
// roughness squared, D is 1 / (pi alpha squared), V is 1 / 4 and F is its value at normal incidence.
GltfBuilder under_the_sun(GltfBuilder made) {
  add_light(made, {{"type", "directional"}, {"intensity", glm::pi<double>()}});
  return made;
}

glm::dvec3 dielectric(const glm::dvec3& base, double roughness) {
  return (1 - 0.04) * base + 0.04 / (4 * std::pow(roughness, 4));
}
glm::dvec3 metal(const glm::dvec3& base, double roughness) { return base / (4 * std::pow(roughness, 4)); }

TEST(OwnMaterials, AnUnlitOneShowsItsColourWhateverShines) {
  const glm::vec4 color(0.25f, 0.5f, 0.75f, 1);
  expect_radiance(shown(unlit_plate(color)).at({0, 0, 0}), color);
  expect_radiance(shown(under_the_sun(unlit_plate(color))).at({0, 0, 0}), color);
}

TEST(OwnMaterials, DielectricAndMetalAndHalfOfEach) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  for (const double roughness : {1.0, 0.5}) {
    const auto at = [&](float metallic) {
      return shown(under_the_sun(lit_plate(base, metallic, float(roughness)))).at({0, 0, 0});
    };
    expect_radiance(at(0), dielectric(base, roughness));
    expect_radiance(at(1), metal(base, roughness));
    expect_radiance(at(0.5f), (dielectric(base, roughness) + metal(base, roughness)) / 2.0);
  }
}

// KHR_materials_specular and KHR_materials_ior on the plate under the sun, seen along its normal.
GltfBuilder reflecting(GltfBuilder made, const json& ior, const json& specular = json::object()) {
  if (!ior.is_null()) material_of(made)["extensions"]["KHR_materials_ior"]["ior"] = ior;
  material_of(made)["extensions"]["KHR_materials_specular"] = specular;
  return made;
}

// (1 - max F) base + F / (4 alpha^2): F = f0 where N = V = L = H.
glm::dvec3 dielectric_of(const glm::dvec3& base, double roughness, const glm::dvec3& f0) {
  return (1 - std::max({f0.r, f0.g, f0.b})) * base + f0 / (4 * std::pow(roughness, 4));
}

TEST(OwnMaterials, IndexOfRefraction) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  for (const double ior : {1.0, 1.33, 1.5, 2.42, 0.0}) {
    SCOPED_TRACE(ior);
    const double f0 = std::pow((ior - 1) / (ior + 1), 2);  // 0, 0.0201, 0.04, 0.1724, 1
    for (const double roughness : {1.0, 0.5}) {
      const GltfBuilder made = reflecting(under_the_sun(lit_plate(base, 0, float(roughness))), ior);
      expect_radiance(shown(made).at({0, 0, 0}), dielectric_of(base, roughness, glm::dvec3(f0)));
    }
  }
}

TEST(OwnMaterials, SpecularFactorAndColour) {
  const glm::dvec3 base(0.2, 0.4, 0.8), color(1, 0.5, 0.125);
  const auto at = [&](const json& ior, const json& specular) {
    return shown(reflecting(under_the_sun(lit_plate(base, 0, 0.5f)), ior, specular)).at({0, 0, 0});
  };
  const json colored = {color.r, color.g, color.b};
  expect_radiance(at(nullptr, {{"specularFactor", 0}}), base);
  expect_radiance(at(nullptr, {{"specularFactor", 0.5}}), dielectric_of(base, 0.5, glm::dvec3(0.02)));
  expect_radiance(at(nullptr, {{"specularColorFactor", colored}}), dielectric_of(base, 0.5, 0.04 * color));
  // 1 at most, before the factor: ior 3 has 0.25, times 8 is 2, 1 and 0.25.
  expect_radiance(at(3, {{"specularFactor", 0.5}, {"specularColorFactor", {8, 4, 1}}}),
                  dielectric_of(base, 0.5, {0.5, 0.5, 0.125}));
}

// The plate turned until eye and sun both are 80 degrees from its normal, on opposite sides: H = N, V.H = cos
// 80, and with alpha = 1 D V = 1 / (4 pi cos 80). Its largest F is F0 + (F90 - F0) (1 - cos 80)^5.
TEST(OwnMaterials, GrazingReflectanceIsTheSpecularFactor) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  const double cosine = std::cos(glm::radians(80.0)), half = glm::radians(80.0) / 2;
  const double g = std::pow(1 - cosine, 5);
  for (const auto& [ior, specular] :
       {std::pair(1.5, 1.0), {1.5, 0.5}, {1.0, 1.0}, {2.42, 0.25}, {1.5, 0.0}}) {
    SCOPED_TRACE(specular);
    GltfBuilder made = reflecting(lit_plate(base), ior, {{"specularFactor", specular}});
    made.node()["rotation"] = {0, std::sin(half), 0, std::cos(half)};
    json& sun = add_light(made, {{"type", "directional"}, {"intensity", glm::pi<double>()}});
    // The light's way is -z of its node: turned by 160 degrees, as the eye's is by 0.
    sun["rotation"] = {0, std::sin(2 * half), 0, std::cos(2 * half)};
    const double f0 = std::pow((ior - 1) / (ior + 1), 2), f = specular * (f0 + (1 - f0) * g);
    expect_radiance(shown(made).at({0, 0, 0}), cosine * (1 - f) * base + glm::dvec3(f / 4));
  }
}

// The factor from alpha; the colour from red, green and blue, which are sRGB. Each with its own UV.
TEST(OwnMaterials, SpecularTextures) {
  const glm::dvec3 base(0.2, 0.4, 0.8), grey = glm::dvec3(std::pow((127 / 255.0 + 0.055) / 1.055, 2.4));
  GltfBuilder made = reflecting(under_the_sun(lit_plate(base, 0, 0.5f)), 2, {{"specularFactor", 0.5}});
  json& specular = material_of(made)["extensions"]["KHR_materials_specular"];
  specular["specularTexture"] = {{"index", add_texels(made, 2, 1, 4, {9, 9, 9, 51, 9, 9, 9, 255})}};
  const double f0 = 1 / 9.0;
  const Picture strengths = shown(made);
  expect_radiance(strengths.at({-0.5, 0, 0}), dielectric_of(base, 0.5, glm::dvec3(0.1 * f0)));
  expect_radiance(strengths.at({0.5, 0, 0}), dielectric_of(base, 0.5, glm::dvec3(0.5 * f0)));
  specular["specularColorTexture"] = {{"index", add_texels(made, 1, 2, 4, {255, 0, 0, 0, 127, 127, 127, 0})},
                                      {"extensions", {{"KHR_texture_transform", {{"offset", {0, 0.5}}}}}}};
  const Picture both = shown(made);
  const auto at = [&](double strength, const glm::dvec3& color) {
    return dielectric_of(base, 0.5, strength * f0 * color);
  };
  expect_quarters(both, {at(0.1, grey), at(0.5, grey), at(0.1, red), at(0.5, red)});
}

// KHR_materials_pbrSpecularGlossiness: F0 is the specular colour, the diffuse part is (1 - its largest
// channel) of the diffuse colour, and the roughness is 1 - glossiness.
GltfBuilder glossy(GltfBuilder made, const json& extension) {
  material_of(made) = {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}, {"metallicFactor", 1}}},
                       {"extensions", {{"KHR_materials_pbrSpecularGlossiness", extension}}}};
  return made;
}

TEST(OwnMaterials, SpecularGlossinessFactors) {
  const glm::dvec3 diffuse(0.2, 0.4, 0.8);
  const json color = {diffuse.r, diffuse.g, diffuse.b, 1};
  for (const glm::dvec3 f0 : {glm::dvec3(0), {0.04, 0.04, 0.04}, {0.5, 0.25, 0.125}, {1, 0.5, 0}}) {
    for (const double roughness : {1.0, 0.5}) {
      const GltfBuilder made = glossy(under_the_sun(plate()), {{"diffuseFactor", color},
                                                               {"specularFactor", {f0.r, f0.g, f0.b}},
                                                               {"glossinessFactor", 1 - roughness}});
      expect_radiance(shown(made).at({0, 0, 0}), dielectric_of(diffuse, roughness, f0));
    }
  }
  // Without factors it is a white mirror without a diffuse part.
  const Material mirror = glossy(plate(), json::object()).load().materials.at(0);
  EXPECT_EQ(mirror.base_color, glm::vec4(1));
  EXPECT_EQ(mirror.roughness, 0);
  EXPECT_EQ(dielectric_f0(mirror), glm::vec3(1));
}

// The two textures have different sizes, transforms and sets of coordinates.
TEST(OwnMaterials, SpecularGlossinessTextures) {
  GltfBuilder made = under_the_sun(plate());
  made.attribute("TEXCOORD_1", std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", f32, 4);
  const json transform = {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"texCoord", 1}}}};
  const int diffuse = add_texels(made, 1, 2, 3, {255, 0, 0, 0, 255, 0});
  const int specular = add_texels(made, 2, 1, 4, {0, 0, 255, 51, 255, 255, 255, 102});
  made = glossy(made, {{"diffuseFactor", {0.5, 0.25, 1, 1}},
                       {"diffuseTexture", {{"index", diffuse}}},
                       {"specularFactor", {0.25, 0.75, 0.5}},
                       {"glossinessFactor", 0.5},
                       {"specularGlossinessTexture", {{"index", specular}, {"extensions", transform}}}});
  const glm::dvec3 upper(0.5, 0, 0), lower(0, 0.25, 0), left(0.25, 0.75, 0.5), right(0, 0, 0.5);
  // Glossiness 0.5 * 102 / 255 and 0.5 * 51 / 255, to the nearest of 255 steps.
  const double rough_left = 204 / 255.0, rough_right = 230 / 255.0;
  expect_quarters(shown(made),
                  {dielectric_of(upper, rough_left, left), dielectric_of(upper, rough_right, right),
                   dielectric_of(lower, rough_left, left), dielectric_of(lower, rough_right, right)});
}

// KHR_materials_unlit wins, and shows the metallic-roughness base colour.
TEST(OwnMaterials, SpecularGlossinessOfAnUnlitMaterialIsNotUsed) {
  GltfBuilder made = glossy(under_the_sun(plate()), {{"diffuseFactor", {0.5, 0.25, 1, 1}}});
  material_of(made)["extensions"]["KHR_materials_unlit"] = json::object();
  expect_radiance(shown(made).at({0, 0, 0}), green);
}

TEST(OwnMaterials, MetalsHaveNoReflectanceOfTheirOwn) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  const json specular = {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0, 0}}};
  const glm::dvec3 coated = dielectric_of(base, 0.5, {0.5 / 9, 0, 0});
  for (const float metallic : {1.0f, 0.5f}) {
    const GltfBuilder made = reflecting(under_the_sun(lit_plate(base, metallic, 0.5f)), 2, specular);
    expect_radiance(shown(made).at({0, 0, 0}), glm::mix(coated, metal(base, 0.5), double(metallic)));
  }
  GltfBuilder made = reflecting(under_the_sun(lit_plate(base, 1, 0.5f)), 2, specular);
  const int texture = add_texels(made, 2, 1, 3, {7, 255, 0, 99, 255, 255});
  material_of(made)["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", texture}};
  const Picture picture = shown(made);
  expect_radiance(picture.at({-0.5, 0, 0}), coated);
  expect_radiance(picture.at({0.5, 0, 0}), metal(base, 0.5));
}

// Green is roughness and blue metalness, times the factors.
TEST(OwnMaterials, MetallicRoughnessTexture) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  GltfBuilder made = under_the_sun(lit_plate(base, 1, 0.5f));
  const int texture = add_texels(made, 2, 1, 3, {7, 255, 0, 99, 255, 255});
  material_of(made)["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", texture}};
  const Picture picture = shown(made);
  expect_radiance(picture.at({-0.5, 0, 0}), dielectric(base, 0.5));
  expect_radiance(picture.at({0.5, 0, 0}), metal(base, 0.5));
}

TEST(OwnMaterials, EmissionTimesItsStrengthNeedsNoLight) {
  GltfBuilder made = lit_plate({1, 1, 1});
  material_of(made)["emissiveFactor"] = {0.5, 0.25, 1};
  material_of(made)["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 8;
  expect_radiance(shown(made).at({0, 0, 0}), {4, 2, 8});
}

// At roughness 1, D is 1 / pi and V is 1 / (2 (N.L + N.V)).
TEST(OwnMaterials, ANormalMapTiltsTheNormal) {
  const glm::dvec3 base(0.2, 0.4, 0.8);
  GltfBuilder made = under_the_sun(lit_plate(base));
  material_of(made)["normalTexture"] = {{"index", add_texels(made, 1, 1, 3, {204, 128, 230})}};
  const double cosine = glm::normalize(glm::dvec3(204, 128, 230) / 255.0 * 2.0 - 1.0).z;
  expect_radiance(shown(made).at({0, 0, 0}), cosine * (0.96 * base + 0.04 / (4 * cosine)));
}

TEST(OwnMaterials, ATextureHasItsOriginAtTheUpperLeft) {
  GltfBuilder made = unlit_plate({1, 1, 1, 1});
  material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_four_colors(made)}};
  expect_quarters(shown(made), {red, green, blue, white});
}

Picture transformed(const json& transform) {
  GltfBuilder made = unlit_plate({1, 1, 1, 1});
  material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", add_four_colors(made)}, {"extensions", {{"KHR_texture_transform", transform}}}};
  return shown(made);
}

TEST(OwnMaterials, TextureTransforms) {
  expect_quarters(transformed({{"offset", {0.5, 0}}}), {green, red, white, blue});
  expect_quarters(transformed({{"scale", {0.5, 1}}}), {red, red, blue, blue});
  // A clockwise quarter turn of the image: lower left goes to upper left.
  expect_quarters(transformed({{"rotation", glm::half_pi<double>()}, {"offset", {0, 1}}}),
                  {blue, red, white, green});
  // Scaled, then turned, then moved: (u, v) to (u / 2, v), to (v, -u / 2), to (v, 1 - u / 2).
  const json all = {{"scale", {0.5, 1}}, {"rotation", glm::half_pi<double>()}, {"offset", {0, 1}}};
  expect_quarters(transformed(all), {blue, blue, white, white});
}

// The texture has a red and a blue texel; u goes from -1 to 1.
TEST(OwnMaterials, WrapModes) {
  const auto wrapped = [](int wrap_s) {
    GltfBuilder made = unlit_plate({1, 1, 1, 1});
    material_of(made)["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", add_texels(made, 2, 1, 3, {255, 0, 0, 0, 0, 255}, wrap_s)},
        {"extensions", {{"KHR_texture_transform", {{"offset", {-1, 0}}, {"scale", {2, 1}}}}}}};
    const Picture picture = shown(made);
    std::string texels;
    for (const double x : {-0.75, -0.25, 0.25, 0.75}) texels += picture.at({x, 0, 0}).r > 0.5f ? 'r' : 'b';
    return texels;
  };
  EXPECT_EQ(wrapped(10497), "rbrb") << "repeat";
  EXPECT_EQ(wrapped(33071), "rrrb") << "clamp";
  EXPECT_EQ(wrapped(33648), "brrb") << "mirror";
}

// Base colour with the first set, emission with the second, in which the image is mirrored. The set of a
// transform overrides the texture's.
TEST(OwnMaterials, TwoUvSetsServeTwoMaps) {
  for (const bool by_transform : {false, true}) {
    GltfBuilder made = under_the_sun(lit_plate({1, 1, 1}));
    made.attribute("TEXCOORD_1", std::vector<float>{1, 1, 0, 1, 0, 0, 1, 0}, "VEC2", f32, 4);
    json& material = material_of(made);
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_four_colors(made)}};
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", add_four_colors(made)}, {"texCoord", by_transform ? 0 : 1}};
    if (by_transform) material["emissiveTexture"]["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
    expect_quarters(shown(made), {dielectric(red, 1) + green, dielectric(green, 1) + red,
                                  dielectric(blue, 1) + white, dielectric(white, 1) + blue});
  }
}

// Texels of alpha 0, 64, 128 and 255: a cutoff keeps values equal to it.
TEST(OwnMaterials, AlphaModes) {
  const auto over = [](const json& mode) {
    GltfBuilder made = unlit_plate({1, 1, 1, 1});
    json& material = material_of(made);
    material["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", add_texels(made, 4, 1, 4, {255, 0, 0, 0, 255, 0, 0, 64, 255, 0, 0, 128, 255, 0, 0, 255})}};
    material.update(mode);
    // A second plate a metre behind.
    made.root["materials"].push_back(unlit({0, 0, 1, 1}));
    json behind = made.root["meshes"][0];
    behind["primitives"][0]["material"] = 1;
    made.root["meshes"].push_back(behind);
    made.root["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, -1}}});
    made.root["scenes"][0]["nodes"].push_back(2);
    return shown(made);
  };
  const auto expect_red = [](const Picture& picture, const std::array<double, 4>& shares) {
    for (int i = 0; i < 4; ++i) {
      SCOPED_TRACE(i);
      expect_radiance(picture.at({-0.75 + 0.5 * i, 0, 0}), {shares[i], 0, 1 - shares[i]});
    }
  };
  expect_red(over(json::object()), {1, 1, 1, 1});
  expect_red(over({{"alphaMode", "MASK"}}), {0, 0, 1, 1});
  expect_red(over({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}), {0, 1, 1, 1});
  expect_red(over({{"alphaMode", "MASK"}, {"alphaCutoff", 1}}), {0, 0, 0, 1});
  expect_red(over({{"alphaMode", "MASK"}, {"alphaCutoff", 0}}), {1, 1, 1, 1});
  expect_red(over({{"alphaMode", "BLEND"}}), {0, 64 / 255.0, 128 / 255.0, 1});
}

}  // namespace
}  // namespace lightgrid
