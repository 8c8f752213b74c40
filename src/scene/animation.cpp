#include "scene/animation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/deform.h"
#include "scene/pose.h"

namespace lightgrid {
namespace {

void check_animation(const Scene& scene, int animation) {
  if (animation >= -1 && animation < animation_count(scene)) return;
  throw input_error("{}: animation {} was asked for, but there are {}", scene.rig ? scene.rig->file : scene.name, animation,
                    animation_count(scene));
}

Pose pose_at(const Rig& rig, double seconds, int animation) {
  return seconds == 0 && animation < 0 ? rest_pose(rig) : animated_pose(rig, seconds, animation);
}

// Light directions and camera axes on nodes that have none in a pose. Rare, so the rest pose is made only then.
class RestFallback {
 public:
  explicit RestFallback(const Rig& rig) : rig_(rig) {}

  const glm::dmat4& world_from_node(int node) {
    if (!pose_) pose_ = rest_pose(rig_);
    return pose_->world_from_node[node];
  }

 private:
  const Rig& rig_;
  std::optional<Pose> pose_;
};

template <typename T>
bool assign(T& to, const T& value) {
  if (to == value) return false;
  to = value;
  return true;
}

bool move_light(Light& light, const glm::dmat4& world, RestFallback& rest) {
  std::optional<glm::vec3> direction = light_direction(world);
  if (!direction) direction = light_direction(rest.world_from_node(light.node));
  const bool moved = assign(light.position, glm::dvec3(world[3]));
  const bool turned = assign(light.direction, direction.value_or(Light().direction));
  return moved || turned;
}

bool move_camera(Camera& camera, const glm::dmat4& world, RestFallback& rest) {
  std::optional<glm::dmat4> rigid = rigid_part(world);
  if (!rigid) {
    rigid = rigid_part(rest.world_from_node(camera.node));
    if (rigid) (*rigid)[3] = world[3];
  }
  return rigid && assign(camera.world_from_view, *rigid);
}

// The morph weights and joint matrices that give a mesh its shape.
struct ShapeInputs {
  std::vector<double> weights;
  std::vector<glm::dmat4> joints;
  bool operator==(const ShapeInputs&) const = default;
};

ShapeInputs inputs_of(const Rig& rig, const DeformingMesh& shape, const Pose& pose) {
  ShapeInputs inputs{shape.rest_weights, {}};
  if (const auto animated = pose.weights.find(shape.weights_node); animated != pose.weights.end()) {
    inputs.weights = animated->second;
  }
  if (shape.skin >= 0) inputs.joints = joint_matrices(rig.skins[shape.skin], pose.world_from_node);
  return inputs;
}

void update_mesh(const Rig& rig, const DeformingMesh& shape, const ShapeInputs& inputs, double seconds, Mesh& mesh) {
  deform(shape, inputs.weights, inputs.joints, mesh);
  if (const auto vertex = first_not_finite(mesh)) {
    throw input_error("{}: {}: vertex {} is moved to infinity at {} s", rig.file, shape.label, *vertex, seconds);
  }
}

}  // namespace

SceneChanges set_time(Scene& scene, double seconds, int animation) {
  if (!std::isfinite(seconds)) throw input_error("{}: time {} is not a finite number of seconds", scene.name, seconds);
  check_animation(scene, animation);
  if (!scene.rig) return {};
  const Rig& rig = *scene.rig;
  const Pose pose = pose_at(rig, seconds, animation);
  std::optional<Pose> before;  // nothing after an error: then all shapes are made again
  if (!std::isnan(scene.time_s)) before = pose_at(rig, scene.time_s, scene.animation);
  scene.time_s = std::numeric_limits<double>::quiet_NaN();

  SceneChanges changes;
  RestFallback rest(rig);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    Instance& instance = scene.instances[i];
    if (instance.node < 0) continue;
    if (assign(instance.world_from_object, world_of_instance(pose.world_from_node[instance.node]))) changes.instances.push_back(int(i));
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const int node = scene.lights[i].node;
    if (node >= 0 && move_light(scene.lights[i], pose.world_from_node[node], rest)) changes.lights.push_back(int(i));
  }
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const int node = scene.cameras[i].node;
    if (node >= 0 && move_camera(scene.cameras[i], pose.world_from_node[node], rest)) changes.cameras.push_back(int(i));
  }
  for (const DeformingMesh& shape : rig.meshes) {
    const ShapeInputs inputs = inputs_of(rig, shape, pose);
    if (before && inputs == inputs_of(rig, shape, *before)) continue;
    update_mesh(rig, shape, inputs, seconds, scene.meshes[shape.mesh]);
    changes.meshes.push_back(shape.mesh);
  }
  scene.time_s = seconds;
  scene.animation = animation;
  return changes;
}

double duration_of(const Scene& scene, int animation) {
  check_animation(scene, animation);
  double duration = 0;
  for (int i = 0; i < animation_count(scene); ++i) {
    if (animation >= 0 && animation != i) continue;
    for (const AnimationChannel& channel : scene.rig->animations[i].channels) {
      duration = std::max(duration, double(channel.times.back()));
    }
  }
  return duration;
}

int animation_count(const Scene& scene) { return scene.rig ? int(scene.rig->animations.size()) : 0; }

}  // namespace lightgrid
