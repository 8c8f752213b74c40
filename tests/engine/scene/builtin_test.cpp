#include "scenes/builtin.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/camera.h"

namespace lightgrid {
namespace {

class BuiltinScenes : public testing::TestWithParam<const char*> {
 protected:
  static Scene make() { return find_builtin_scene(GetParam())->make(); }
};

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST_P(BuiltinScenes, MeshesAreWhole) {
  const Scene scene = make();
  for (const Mesh& mesh : scene.meshes) {
    SCOPED_TRACE(mesh.name);
    const size_t count = mesh.positions.size();
    ASSERT_GT(mesh.indices.size(), 0);
    ASSERT_EQ(mesh.indices.size() % 3, 0);
    ASSERT_EQ(mesh.normals.size(), count);
    ASSERT_EQ(mesh.tangents.size(), count);
    ASSERT_EQ(mesh.uv0.size(), count);
    ASSERT_LT(size_t(mesh.material), scene.materials.size());
    Aabb bounds;
    for (size_t i = 0; i < count; ++i) {
      bounds.add(mesh.positions[i]);
      ASSERT_TRUE(is_finite(mesh.positions[i]) && is_finite(glm::vec3(mesh.uv0[i], 0)));
      ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5);
      ASSERT_NEAR(glm::length(glm::vec3(mesh.tangents[i])), 1, 1e-5);
      ASSERT_NEAR(glm::dot(mesh.normals[i], glm::vec3(mesh.tangents[i])), 0, 1e-5);
      ASSERT_EQ(std::abs(mesh.tangents[i].w), 1);
    }
    EXPECT_EQ(mesh.bounds.min, bounds.min);
    EXPECT_EQ(mesh.bounds.max, bounds.max);
  }
}

TEST_P(BuiltinScenes, TrianglesHaveAreaAndFaceTheirNormals) {
  for (const Mesh& mesh : make().meshes) {
    SCOPED_TRACE(mesh.name);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      ASSERT_LT(std::max({a, b, c}), mesh.positions.size());
      const glm::vec3 doubled =
          glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
      ASSERT_GT(glm::length(doubled), 1e-9f);
      const glm::vec3 face = glm::normalize(doubled);
      for (const uint32_t corner : {a, b, c})
        ASSERT_GT(glm::dot(face, mesh.normals[corner]), 0.3f) << "triangle " << i / 3;
    }
  }
}

// glTF: tangent along growing u, and cross(normal, tangent) * w along falling v.
TEST_P(BuiltinScenes, TangentsFollowTheTextureCoordinates) {
  for (const Mesh& mesh : make().meshes) {
    SCOPED_TRACE(mesh.name);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      const glm::vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
      const glm::vec2 d1 = mesh.uv0[b] - mesh.uv0[a], d2 = mesh.uv0[c] - mesh.uv0[a];
      const float determinant = d1.x * d2.y - d2.x * d1.y;
      ASSERT_NE(determinant, 0) << "triangle " << i / 3;
      const glm::vec3 along_u = (e1 * d2.y - e2 * d1.y) / determinant,
                      along_v = (e2 * d1.x - e1 * d2.x) / determinant;
      const glm::vec3 normal = mesh.normals[a], tangent(mesh.tangents[a]);
      ASSERT_GT(glm::dot(glm::normalize(along_u), tangent), 0.5f) << "triangle " << i / 3;
      ASSERT_GT(glm::dot(glm::normalize(-along_v), glm::cross(normal, tangent) * mesh.tangents[a].w), 0.5f)
          << "triangle " << i / 3;
    }
  }
}

TEST_P(BuiltinScenes, MaterialsAndInstancesReferToWhatIsThere) {
  const Scene scene = make();
  for (const Bitmap& bitmap : scene.bitmaps)
    EXPECT_EQ(bitmap.rgba.size(), size_t(bitmap.width) * bitmap.height * 4);
  for (const Texture& texture : scene.textures) EXPECT_LT(size_t(texture.bitmap), scene.bitmaps.size());
  for (const Material& m : scene.materials) {
    for (const TextureSlot* slot :
         {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.occlusion_map, &m.emissive_map}) {
      EXPECT_LT(slot->texture, int(scene.textures.size()));
    }
  }
  std::set<int> used;
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(size_t(instance.mesh), scene.meshes.size());
    EXPECT_GT(glm::determinant(glm::dmat3(instance.world_from_object)), 0);
    used.insert(instance.mesh);
  }
  EXPECT_EQ(used.size(), scene.meshes.size()) << "meshes without an instance";
}

TEST_P(BuiltinScenes, LightsAreValidAndBounded) {
  const WorldBox box = world_box(make());
  for (const Light& light : make().lights) {
    SCOPED_TRACE(light.name);
    EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
    EXPECT_GT(light.intensity, 0);
    EXPECT_GT(std::max({light.color.r, light.color.g, light.color.b}), 0);
    if (light.type == LightType::directional) continue;
    EXPECT_TRUE(light.radius_m > 0 && std::isfinite(light.radius_m));
    EXPECT_TRUE(light.inner_cone_rad >= 0 && light.inner_cone_rad < light.outer_cone_rad);
    const glm::dvec3 nearest = glm::clamp(light.position, box.min, box.max);
    EXPECT_LT(glm::length(nearest - light.position), light.radius_m) << "lights nothing";
  }
}

TEST_P(BuiltinScenes, CamerasMakeViewsOfTheScene) {
  const Scene scene = make();
  ASSERT_FALSE(scene.cameras.empty());
  std::set<std::string> names;
  for (const Camera& camera : scene.cameras) {
    EXPECT_FALSE(camera.name.empty());
    EXPECT_TRUE(names.insert(camera.name).second);
    EXPECT_NO_THROW(make_view(camera, 1280, 720));
  }
}

TEST_P(BuiltinScenes, TwiceTheSame) {
  const Scene a = make(), b = make();
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (size_t i = 0; i < a.lights.size(); ++i) EXPECT_EQ(a.lights[i].position, b.lights[i].position);
  ASSERT_EQ(a.bitmaps.size(), b.bitmaps.size());
  for (size_t i = 0; i < a.bitmaps.size(); ++i) EXPECT_EQ(a.bitmaps[i].rgba, b.bitmaps[i].rgba);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t i = 0; i < a.meshes.size(); ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes,
                         testing::Values("hall", "spheres", "terrain", "street", "particles", "gallery",
                                         "square", "rooms"),
                         [](const auto& info) { return std::string(info.param); });

TEST(BuiltinSceneList, CountsAreThoseOfTheDocumentation) {
  const struct {
    const char* name;
    size_t triangles;
    int points, spots, directional;
  } documented[] = {{"hall", 87'384, 221, 16, 0},      {"spheres", 188'160, 1024, 0, 0},
                    {"terrain", 52568, 255, 0, 1},     {"street", 91'136, 658, 132, 1},
                    {"particles", 4'320, 325, 12, 0},  {"gallery", 216'108, 181, 29, 0},
                    {"square", 2'839'196, 270, 30, 0}, {"rooms", 15'188, 54, 3, 1}};
  ASSERT_EQ(builtin_scenes().size(), std::size(documented));
  for (const auto& expected : documented) {
    const Scene scene = find_builtin_scene(expected.name)->make();
    size_t triangles = 0;
    int lights[3] = {};
    for (const Instance& i : scene.instances) triangles += scene.meshes[i.mesh].indices.size() / 3;
    for (const Light& light : scene.lights) ++lights[int(light.type)];
    EXPECT_EQ(triangles, expected.triangles) << expected.name;
    EXPECT_THAT(lights, testing::ElementsAre(expected.points, expected.spots, expected.directional));
  }
}

TEST(BuiltinSceneList, UnknownNamesAreNotFound) {
  EXPECT_EQ(find_builtin_scene("cellar"), nullptr);
  EXPECT_EQ(find_builtin_scene(""), nullptr);
}

}  // namespace
}  // namespace lightgrid
