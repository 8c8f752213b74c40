// The large scenes and those with artists' lights.
#include <algorithm>

#include "base/error.h"
#include "scene/deform.h"
#include "scene/load_gltf.h"
#include "support/shared_files.h"

namespace lightgrid {
namespace {

std::filesystem::path scene_file(const char* name) { return shared_folder() / "scenes" / name; }

void expect_complete(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 2e-4);
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    ASSERT_LT(*std::max_element(mesh.indices.begin(), mesh.indices.end()), mesh.positions.size());
    ASSERT_LT(size_t(mesh.material), scene.materials.size());
    if (scene.materials[mesh.material].normal_map.texture >= 0) {
      ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    }
  }
  for (const Texture& texture : scene.textures) ASSERT_LT(size_t(texture.bitmap), scene.bitmaps.size());
  for (const Bitmap& bitmap : scene.bitmaps)
    ASSERT_EQ(bitmap.rgba.size(), size_t(bitmap.width) * bitmap.height * 4);
}

TEST(GltfScenes, sponza_is_complete) {
  LIGHTGRID_NEEDS_SHARED("scenes/large/Sponza");
  const Scene scene = load_gltf(scene_file("large/Sponza/Sponza.gltf"));
  expect_complete(scene);
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.indices.size() / 3;
  EXPECT_EQ(triangles, 262267u);
  EXPECT_EQ(scene.instances.size(), 103u);
  EXPECT_EQ(scene.materials.size(), 25u);
  EXPECT_EQ(scene.bitmaps.size(), 65u) << "of 69 files four have the same bytes as another";
  EXPECT_TRUE(scene.lights.empty());
  const auto masked = std::count_if(scene.materials.begin(), scene.materials.end(),
                                    [](const Material& m) { return m.alpha_mode == AlphaMode::mask; });
  EXPECT_EQ(masked, 3);
  const WorldBox box = world_box(scene);
  EXPECT_NEAR(box.min.x, -15.4, 0.05);
  EXPECT_NEAR(box.max.x, 14.4, 0.05);
  EXPECT_NEAR(box.max.y, 11.4, 0.05);
  EXPECT_NEAR(box.min.z, -9.5, 0.05);
}

TEST(GltfScenes, flight_helmet_is_complete) {
  LIGHTGRID_NEEDS_SHARED("scenes/large/FlightHelmet");
  const Scene scene = load_gltf(scene_file("large/FlightHelmet/FlightHelmet.gltf"));
  expect_complete(scene);
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.indices.size() / 3;
  EXPECT_EQ(triangles, 94722u);
  EXPECT_EQ(scene.materials.size(), 6u);
  EXPECT_EQ(scene.bitmaps.size(), 15u);
  EXPECT_TRUE(std::any_of(scene.materials.begin(), scene.materials.end(),
                          [](const Material& m) { return m.alpha_mode == AlphaMode::blend; }));
}

// The file's tangents are from MikkTSpace, which splits vertices that are shared here.
TEST(GltfScenes, made_tangents_agree_with_those_of_flight_helmet) {
  LIGHTGRID_NEEDS_SHARED("scenes/large/FlightHelmet");
  const Scene scene = load_gltf(scene_file("large/FlightHelmet/FlightHelmet.gltf"));
  size_t count = 0, close = 0;
  for (const Mesh& mesh : scene.meshes) {
    Mesh made = mesh;
    make_tangents(made, mesh.uv0);
    for (size_t i = 0; i < mesh.tangents.size(); ++i, ++count)
      close += made.tangents[i].w == mesh.tangents[i].w &&
               glm::dot(glm::vec3(made.tangents[i]), glm::vec3(mesh.tangents[i])) > 0.95f;
  }
  ASSERT_GT(count, 50000u);
  EXPECT_GT(close, count / 100 * 99);
}

TEST(GltfScenes, tps_demo_places_nine_lights_on_twenty_nodes) {
  LIGHTGRID_NEEDS_SHARED("scenes/lights/TpsDemoLights");
  const Scene scene = load_gltf(scene_file("lights/TpsDemoLights/lights.glb"));
  ASSERT_EQ(scene.lights.size(), 20u);
  EXPECT_EQ(std::count_if(scene.lights.begin(), scene.lights.end(),
                          [](const Light& light) { return light.type == LightType::spot; }),
            13);
  for (const Light& light : scene.lights) EXPECT_EQ(light.intensity, 100);
}

// Its spots of 180 degrees have the float next to pi/2, which lies above pi/2 in double precision.
TEST(GltfScenes, a_cone_of_ninety_degrees_in_float_loads) {
  LIGHTGRID_NEEDS_SHARED("scenes/lights/BistroExteriorFakeGI");
  const Scene scene = load_gltf(scene_file("lights/BistroExteriorFakeGI/BistroExteriorFakeGI.gltf"));
  ASSERT_FALSE(scene.lights.empty());
  EXPECT_EQ(scene.lights[0].type, LightType::spot);
  EXPECT_EQ(scene.lights[0].outer_cone_rad, 1.57079637f);
}

}  // namespace
}  // namespace lightgrid
