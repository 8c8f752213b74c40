// The animated conformance models: each instance, light, camera and skinned vertex at several times, against
// the oracle of poses.
#include <cmath>
#include <cstdio>

#include "conformance/pose_oracle.h"
#include "scene/animation.h"
#include "scene/load_gltf.h"
#include "scene/rig.h"
#include "support/shared_files.h"

namespace lightgrid {
namespace {

struct PosedModel {
  Scene scene;
  PoseOracle oracle;
};

std::optional<PosedModel> load_posed_model(const char* name) {
  const std::filesystem::path path = shared_folder() / "scenes/conformance" / name;
  if (!std::filesystem::exists(path)) return {};
  return PosedModel{load_gltf(path), PoseOracle(path)};
}

#define LOAD_OR_SKIP(variable, name)      \
  auto variable = load_posed_model(name); \
  if (!variable) GTEST_SKIP() << "needs shared/scenes/conformance/" << name << ", which is absent"

// The file's index of a node of the rig.
int file_node(const Scene& scene, int node) {
  return std::stoi(scene.rig->nodes.at(size_t(node)).label.substr(5));
}

std::vector<double> times_of(const Scene& scene) {
  const double duration = duration_of(scene);
  return {0,        duration * 0.011, duration * 0.25, duration * 0.37, duration * 0.5, duration * 0.83,
          duration, duration + 1};
}

void expect_matrix(const glm::dmat4& actual, const Affine& expected, double tolerance = 1e-9) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(actual[column][row], expected[row * 4 + column], tolerance);
  }
}

int expect_instances(const PosedModel& model, double seconds) {
  int moving = 0;
  for (const Instance& instance : model.scene.instances) {
    if (instance.node < 0) continue;
    ++moving;
    expect_matrix(instance.world_from_object,
                  model.oracle.world_of_node(file_node(model.scene, instance.node), seconds));
  }
  return moving;
}

// One rounding to float.
void expect_vertices(const std::vector<glm::vec3>& actual, const std::vector<Numbers>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(actual[i][c], expected[i][c], 1e-9 + 0x1p-24 * std::abs(expected[i][c])) << "vertex " << i;
  }
}

// Without normals in the file, triangles are flat and vertices are not shared.
std::vector<Numbers> unshared(const PosedModel& model, const nlohmann::json& primitive,
                              const std::vector<Numbers>& vertices) {
  std::vector<Numbers> out;
  for (const Numbers& index : model.oracle.elements(primitive["indices"]))
    out.push_back(vertices[size_t(index[0])]);
  return out;
}

int expect_skins(const PosedModel& model, double seconds) {
  const nlohmann::json& root = model.oracle.root();
  for (const DeformingMesh& shape : model.scene.rig->meshes) {
    int mesh = -1, primitive_index = -1;
    std::sscanf(shape.label.c_str(), "mesh %d", &mesh);
    std::sscanf(shape.label.substr(shape.label.rfind("primitive")).c_str(), "primitive %d", &primitive_index);
    const nlohmann::json& primitive = root["meshes"][mesh]["primitives"][primitive_index];
    const PoseOracle::Vertices expected = model.oracle.skinned(primitive, shape.skin, seconds);
    const Mesh& posed = model.scene.meshes[shape.mesh];
    const bool has_normals = !expected.normals.empty();
    expect_vertices(posed.positions,
                    has_normals ? expected.positions : unshared(model, primitive, expected.positions));
    if (has_normals) expect_vertices(posed.normals, expected.normals);
    for (const glm::vec3& p : posed.positions) {
      EXPECT_TRUE(glm::all(glm::lessThanEqual(posed.bounds.min, p)) &&
                  glm::all(glm::lessThanEqual(p, posed.bounds.max)));
    }
  }
  return int(model.scene.rig->meshes.size());
}

TEST(GltfPoses, NodesAreInterpolatedInAllThreeWays) {
  LOAD_OR_SKIP(model, "InterpolationTest/InterpolationTest.glb");
  EXPECT_EQ(animation_count(model->scene), 9);
  for (const double seconds : times_of(model->scene)) {
    set_time(model->scene, seconds);
    EXPECT_EQ(expect_instances(*model, seconds), 9);
  }
  // One animation leaves all others at rest.
  set_time(model->scene, 0.7, 4);
  const int node = model->oracle.root()["animations"][4]["channels"][0]["target"]["node"];
  for (const Instance& instance : model->scene.instances) {
    if (instance.node < 0) continue;
    const int at = file_node(model->scene, instance.node);
    expect_matrix(instance.world_from_object, model->oracle.world_of_node(at, at == node ? 0.7 : -1, 4));
  }
}

TEST(GltfPoses, TheTrucksWheelsTurn) {
  LOAD_OR_SKIP(model, "CesiumMilkTruck/CesiumMilkTruck.glb");
  for (const double seconds : times_of(model->scene)) {
    set_time(model->scene, seconds);
    EXPECT_EQ(expect_instances(*model, seconds), 2);
  }
}

TEST(GltfPoses, LightsFollowTheirNodes) {
  LOAD_OR_SKIP(model, "LightOrientation/LightOrientation.gltf");
  int moving = 0;
  for (const double seconds : times_of(model->scene)) {
    set_time(model->scene, seconds);
    for (const Light& light : model->scene.lights) {
      if (light.node < 0) continue;
      ++moving;
      const Affine world = model->oracle.world_of_node(file_node(model->scene, light.node), seconds);
      double length = 0;
      for (int row = 0; row < 3; ++row) length = std::hypot(length, world[row * 4 + 2]);
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(light.position[row], world[row * 4 + 3], 1e-9);
        EXPECT_NEAR(light.direction[row], -world[row * 4 + 2] / length, 2e-7);
      }
    }
  }
  EXPECT_EQ(moving, int(times_of(model->scene).size()) * 2) << "two of the four lights are on animated nodes";
}

TEST(GltfPoses, TheSimpleSkinBends) {
  LOAD_OR_SKIP(model, "SimpleSkin/SimpleSkin.gltf");
  for (const double seconds : times_of(model->scene)) {
    set_time(model->scene, seconds);
    EXPECT_EQ(expect_skins(*model, seconds), 1);
  }
}

TEST(GltfPoses, TheManWalks) {
  LOAD_OR_SKIP(model, "CesiumMan/CesiumMan.gltf");
  const double first_key = model->scene.rig->animations.at(0).channels.at(0).times.at(0);
  for (const double seconds : times_of(model->scene)) {
    // Time 0 already shows the first key.
    const bool unchanged = (seconds > 0 && seconds < first_key) || seconds > duration_of(model->scene);
    EXPECT_EQ(set_time(model->scene, seconds).empty(), unchanged) << seconds;
    EXPECT_EQ(expect_skins(*model, seconds), 1);
  }
}

TEST(GltfPoses, EightyFourSkeletonsWithinEachOther) {
  LOAD_OR_SKIP(model, "RecursiveSkeletons/RecursiveSkeletons.glb");
  for (const double seconds : {0.3, 1.0, 1.7}) {
    set_time(model->scene, seconds);
    EXPECT_EQ(expect_skins(*model, seconds), 84);
  }
}

TEST(GltfPoses, RestIsTheSceneAsLoadedBitForBit) {
  for (const char* name : {"InterpolationTest/InterpolationTest.glb", "CesiumMilkTruck/CesiumMilkTruck.glb",
                           "LightOrientation/LightOrientation.gltf", "SimpleSkin/SimpleSkin.gltf",
                           "CesiumMan/CesiumMan.gltf", "RecursiveSkeletons/RecursiveSkeletons.glb"}) {
    LOAD_OR_SKIP(model, name);
    const Scene loaded = model->scene;
    EXPECT_TRUE(set_time(model->scene, std::nullopt).empty()) << name;
    EXPECT_FALSE(set_time(model->scene, 0.77).empty()) << name;
    set_time(model->scene, std::nullopt);
    for (size_t i = 0; i < loaded.instances.size(); ++i) {
      EXPECT_EQ(model->scene.instances[i].world_from_object, loaded.instances[i].world_from_object) << name;
    }
    for (size_t i = 0; i < loaded.lights.size(); ++i) {
      EXPECT_EQ(model->scene.lights[i].position, loaded.lights[i].position) << name;
      EXPECT_EQ(model->scene.lights[i].direction, loaded.lights[i].direction) << name;
    }
    for (size_t i = 0; i < loaded.meshes.size(); ++i) {
      EXPECT_EQ(model->scene.meshes[i].positions, loaded.meshes[i].positions) << name;
      EXPECT_EQ(model->scene.meshes[i].normals, loaded.meshes[i].normals) << name;
      EXPECT_EQ(model->scene.meshes[i].tangents, loaded.meshes[i].tangents) << name;
      EXPECT_EQ(model->scene.meshes[i].bounds.min, loaded.meshes[i].bounds.min) << name;
      EXPECT_EQ(model->scene.meshes[i].bounds.max, loaded.meshes[i].bounds.max) << name;
    }
  }
}

}  // namespace
}  // namespace lightgrid
