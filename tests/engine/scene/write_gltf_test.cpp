#include "scene/write_gltf.h"
#include "scene/environment_light.h"
#include "scene/light_groups.h"

#include <gmock/gmock.h>

#include <numbers>

#include "scenes/builtin.h"
#include "support/error_of.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

Scene read_back(const Scene& scene) {
  const ModelFolder folder;
  return load_gltf(folder.write("scene.glb", glb_of(scene)));
}

void expect_same_slot(const TextureSlot& a, const TextureSlot& b, const Scene& of_a, const Scene& of_b) {
  ASSERT_EQ(a.texture >= 0, b.texture >= 0);
  if (a.texture < 0) return;
  const Texture &x = of_a.textures[size_t(a.texture)], &y = of_b.textures[size_t(b.texture)];
  EXPECT_EQ(of_a.bitmaps[size_t(x.bitmap)].rgba, of_b.bitmaps[size_t(y.bitmap)].rgba);
  EXPECT_EQ(x.srgb, y.srgb);
  EXPECT_EQ(x.wrap_u, y.wrap_u);
  EXPECT_EQ(x.wrap_v, y.wrap_v);
  EXPECT_EQ(x.min_filter, y.min_filter);
  EXPECT_EQ(x.mag_linear, y.mag_linear);
  EXPECT_EQ(a.uv_set, b.uv_set);
  for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(a.uv_from_vertex[i] - b.uv_from_vertex[i]), 1e-6f) << i;
}

void expect_same_material(const Material& a, const Material& b, const Scene& of_a, const Scene& of_b) {
  EXPECT_EQ(a.name, b.name);
  for (const auto field :
       {&Material::metallic, &Material::roughness, &Material::occlusion_strength, &Material::clearcoat,
        &Material::clearcoat_roughness, &Material::ior, &Material::specular})
    EXPECT_EQ(a.*field, b.*field) << a.name;
  EXPECT_EQ(a.base_color, b.base_color);
  EXPECT_LT(glm::length(a.emissive - b.emissive), 1e-6f * (1 + glm::length(a.emissive)));
  EXPECT_EQ(a.specular_color, b.specular_color);
  EXPECT_EQ(a.alpha_mode, b.alpha_mode);
  if (a.alpha_mode == AlphaMode::mask) {
    EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
  }
  EXPECT_EQ(a.double_sided, b.double_sided);
  EXPECT_EQ(a.unlit, b.unlit);
  EXPECT_EQ(a.model.skin(), b.model.skin()) << a.name;
  EXPECT_EQ(a.model.minnaert_k, b.model.minnaert_k) << a.name;
  if (a.model.skin()) {
    EXPECT_EQ(a.model, b.model) << a.name;
  }
  if (a.normal_map.texture >= 0) {
    EXPECT_EQ(a.normal_scale, b.normal_scale);
  }
  for (const auto slot : {&Material::base_color_map, &Material::metallic_roughness_map, &Material::normal_map,
                          &Material::occlusion_map, &Material::emissive_map})
    expect_same_slot(a.*slot, b.*slot, of_a, of_b);
}

void expect_same_lights(const std::vector<Light>& a, std::vector<Light> b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].type == LightType::point) {
      b[i].direction = a[i].direction;  // means nothing
    } else {
      EXPECT_LT(glm::length(a[i].direction - b[i].direction), 2e-7f) << i;  // its matrix is normalised anew
    }
    b[i].direction = a[i].direction;
    if (is_directional(a[i])) b[i].position = a[i].position;
    if (!has_cone(a[i])) {
      b[i].inner_cone_rad = a[i].inner_cone_rad;
      b[i].outer_cone_rad = a[i].outer_cone_rad;
    }
    EXPECT_TRUE(a[i] == b[i]) << i << " " << a[i].name;
  }
}

TEST(WriteGltf, EachBuiltinSceneIsReadBackAsItWas) {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    if (builtin.large) continue;
    SCOPED_TRACE(builtin.name);
    const Scene scene = builtin.make(), back = read_back(scene);
    EXPECT_EQ(back.ambient, scene.ambient);
    EXPECT_EQ(back.background, scene.background);
    EXPECT_EQ(back.samples, scene.samples);
    expect_same_lights(scene.lights, back.lights);
    ASSERT_EQ(back.instances.size(), scene.instances.size());
    ASSERT_EQ(back.cameras.size(), scene.cameras.size());
    for (size_t i = 0; i < scene.instances.size(); ++i) {
      const Instance &a = scene.instances[i], &b = back.instances[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.world_from_object, b.world_from_object) << a.name;
      EXPECT_EQ(a.casts_shadow, b.casts_shadow) << a.name;
      EXPECT_EQ(groups_of(a), groups_of(b)) << a.name;
      const Mesh &x = scene.meshes[size_t(a.mesh)], &y = back.meshes[size_t(b.mesh)];
      EXPECT_TRUE(x.positions == y.positions && x.normals == y.normals && x.indices == y.indices) << a.name;
      // The reader keeps what the material reads.
      const Material& material = scene.materials[size_t(x.material)];
      for (const auto& [own, read] : {std::pair(&x.uv0, &y.uv0), std::pair(&x.uv1, &y.uv1)})
        EXPECT_TRUE(read->empty() || *own == *read) << a.name;
      EXPECT_TRUE(material.base_color_map.texture < 0 || x.uv0 == y.uv0) << a.name;
      EXPECT_TRUE(material.normal_map.texture < 0 || x.tangents == y.tangents) << a.name;
      EXPECT_EQ(x.colors, y.colors) << a.name;
      expect_same_material(scene.materials[size_t(x.material)], back.materials[size_t(y.material)], scene,
                           back);
    }
  }
}

Scene triangle_with(const Light& light) {
  Scene scene = GltfBuilder::triangle().load();
  scene.lights = {light};
  return scene;
}

TEST(WriteGltf, LightsKeepTheirPlaceInDoubleTheirConesAndTheirExtras) {
  Light spot{.name = "spot", .type = LightType::spot, .position = {1e7 + 1.0 / 3, -2, 0.1}};
  spot.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  spot.radius_m = 7.3f;
  spot.intensity = 123.4f;
  spot.color = {0.1f, 0.2f, 1};
  spot.inner_cone_rad = 0.1f;
  spot.outer_cone_rad = std::numbers::pi_v<float> / 2;
  spot.casts_shadow = true;
  spot.source_m = 0.05f;
  set_groups(spot, 0b101);
  Light endless{.name = "endless", .position = {1, 2, 3}};
  Light sun{.name = "sun", .type = LightType::directional, .direction = {0, -1, 0}};
  for (const Light& light : {spot, endless, sun}) {
    SCOPED_TRACE(light.name);
    expect_same_lights({light}, read_back(triangle_with(light)).lights);
  }
}

TEST(WriteGltf, MaterialsKeepWhatTheirExtensionsHold) {
  Scene scene = GltfBuilder::triangle().load();
  scene.bitmaps = {{.name = "dots", .width = 2, .height = 1, .rgba = {1, 2, 3, 0, 250, 251, 252, 255}}};
  scene.textures = {{.bitmap = 0,
                     .srgb = true,
                     .wrap_u = Wrap::clamp,
                     .wrap_v = Wrap::mirror,
                     .min_filter = Filter::nearest_mipmap_linear,
                     .mag_linear = false}};
  scene.meshes[0].uv0 = {{0, 0}, {1, 0}, {0, 1}};
  Material& m = scene.materials[size_t(scene.meshes[0].material)];
  m.base_color_map = {.texture = 0, .uv_set = 0};
  const float c = std::cos(0.7f), s = std::sin(0.7f);  // scaled, one side mirrored, and turned
  m.base_color_map.uv_from_vertex = {2 * c, -2 * s, -3 * s, -3 * c, 0.25f, -4};
  m.emissive = {0.1f, 30, 2};
  m.clearcoat = 0.5f;
  m.clearcoat_roughness = 0.25f;
  m.ior = 1.3f;
  m.specular = 0.7f;
  m.specular_color = {0.5f, 1, 2};
  m.alpha_mode = AlphaMode::mask;
  m.alpha_cutoff = 0.3f;
  m.double_sided = true;
  const Scene back = read_back(scene);
  expect_same_material(m, back.materials.at(size_t(back.meshes.at(0).material)), scene, back);
  m.unlit = true;
  m.clearcoat = 0;
  EXPECT_TRUE(read_back(scene).materials.at(0).unlit);
}

TEST(WriteGltf, VirtualLightsAreRefused) {
  Light light;
  light.is_virtual = true;
  EXPECT_THAT(error_of([&] { glb_of(triangle_with(light)); }), HasSubstr("virtual lights"));
}

TEST(WriteGltf, LightFromSurroundingsIsRefused) {
  Scene scene;
  scene.environment = make_environment({"white", 1, 1, {glm::vec3(1)}});
  EXPECT_THAT(error_of([&] { glb_of(scene); }), HasSubstr("light from surroundings"));
}

}  // namespace
}  // namespace lightgrid
