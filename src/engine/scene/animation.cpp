#include "scene/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>

#include "base/error.h"
#include "scene/deform.h"
#include "scene/light_axes.h"
#include "scene/pose.h"

namespace lightgrid {
namespace {

void check_animation(const Scene& scene, int animation) {
  if (animation >= -1 && animation < animation_count(scene)) return;
  throw input_error("{}: animation {} was requested, but there are {}",
                    scene.rig ? scene.rig->file : scene.name, animation, animation_count(scene));
}

Pose pose_at(const Rig& rig, std::optional<double> seconds, int animation) {
  return seconds ? animated_pose(rig, *seconds, animation) : rest_pose(rig);
}

// Light directions and camera axes of the rest pose, for nodes without any in the current pose. Rare, so
// computed on demand.
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
  const bool rolled = !light.properties.values().empty() && set_up(light, glm::dvec3(world[1]));
  return moved || turned || rolled;
}

// The value of an animated property as the loader reads it at rest: exporters' splines may overshoot.
float light_value(double value, double low, double high) {
  return float(value >= low ? std::min(value, high) : low);
}

void animate_light(const Pose& pose, int file_light, Light& light) {
  constexpr double max_float = std::numeric_limits<float>::max();
  const auto value = [&](AnimatedPath path) -> const std::vector<double>* {
    const auto found = pose.lights.find({file_light, path});
    return found == pose.lights.end() ? nullptr : &found->second;
  };
  if (const auto* color = value(AnimatedPath::color))
    for (int i = 0; i < 3; ++i) light.color[i] = light_value((*color)[size_t(i)], 0, max_float);
  if (const auto* intensity = value(AnimatedPath::intensity))
    light.intensity = light_value((*intensity)[0], 0, max_float);
  if (const auto* range = value(AnimatedPath::range); range && light.type != LightType::directional)
    light.radius_m = (*range)[0] > 0 ? float((*range)[0]) : std::numeric_limits<float>::infinity();
  if (const auto* outer = value(AnimatedPath::outer_cone))
    light.outer_cone_rad = light_value((*outer)[0], 1e-6, glm::half_pi<float>());
  if (const auto* inner = value(AnimatedPath::inner_cone))
    light.inner_cone_rad = light_value((*inner)[0], 0, light.outer_cone_rad);
  light.inner_cone_rad = std::min(light.inner_cone_rad, light.outer_cone_rad);
  const float brightest = std::max({light.color.r, light.color.g, light.color.b, 1.0f});
  if (intensity_overflows(light)) light.intensity = std::numeric_limits<float>::max() / brightest;
}

// Sets what KHR_node_visibility and KHR_animation_pointer change. A hidden light reaches nothing.
bool switch_light(const Rig& rig, const Pose& pose, Light& light) {
  const auto found = rig.lights.find(light.node);
  if (found == rig.lights.end()) return false;
  Light now = found->second.rest;
  animate_light(pose, found->second.light, now);
  if (pose.hidden[size_t(light.node)]) {
    now.intensity = 0;
    now.radius_m = 0;
  }
  bool changed = assign(light.color, now.color);
  changed |= assign(light.intensity, now.intensity);
  changed |= assign(light.radius_m, now.radius_m);
  changed |= assign(light.inner_cone_rad, now.inner_cone_rad);
  changed |= assign(light.outer_cone_rad, now.outer_cone_rad);
  return changed;
}

bool move_camera(Camera& camera, const glm::dmat4& world, RestFallback& rest) {
  std::optional<glm::dmat4> rigid = rigid_part(world);
  if (!rigid) {
    rigid = rigid_part(rest.world_from_node(camera.node));
    if (rigid) (*rigid)[3] = world[3];
  }
  return rigid && assign(camera.world_from_view, *rigid);
}

// The values that determine a mesh's shape.
struct ShapeInputs {
  std::vector<double> weights;
  std::vector<glm::dmat4> joints;
  bool mirrored = false;
  bool operator==(const ShapeInputs&) const = default;
};

ShapeInputs inputs_of(const Rig& rig, const DeformingMesh& shape, const Pose& pose) {
  ShapeInputs inputs{shape.rest_weights, {}, shape.mirrored};
  if (const auto animated = pose.weights.find(shape.weights_node); animated != pose.weights.end()) {
    inputs.weights = animated->second;
  }
  if (shape.skin >= 0) inputs.joints = joint_matrices(rig.skins[shape.skin], pose.world_from_node);
  if (shape.winding_node >= 0) inputs.mirrored = is_mirrored(pose.world_from_node[shape.winding_node]);
  return inputs;
}

void update_mesh(const Rig& rig, const DeformingMesh& shape, const ShapeInputs& inputs,
                 std::optional<double> seconds, Mesh& mesh) {
  deform(shape, inputs.weights, inputs.joints, inputs.mirrored, mesh);
  if (const auto vertex = first_not_finite(mesh)) {
    const std::string when = seconds ? fmt::format("{} s", *seconds) : "rest";
    throw input_error("{}: {}: vertex {} is moved to infinity at {}", rig.file, shape.label, *vertex, when);
  }
}

std::vector<int> move_instances(Scene& scene, const Pose& pose) {
  std::vector<char> skinned(scene.meshes.size(), 0);
  for (const DeformingMesh& shape : scene.rig->meshes) skinned[size_t(shape.mesh)] = shape.skin >= 0;
  std::vector<int> changed;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    Instance& instance = scene.instances[i];
    if (instance.node < 0) continue;
    const glm::dmat4& node = pose.world_from_node[instance.node];
    const glm::dmat4 world = pose.hidden[size_t(instance.node)] ? point_at(node[3])
                             : skinned[size_t(instance.mesh)]   ? winding_matrix(is_mirrored(node))
                                                                : world_of_instance(node);
    if (assign(instance.world_from_object, world)) changed.push_back(int(i));
  }
  return changed;
}

// `items`: lights or cameras.
template <typename Item, typename Move>
std::vector<int> move_all(std::vector<Item>& items, const Pose& pose, RestFallback& rest, const Move& move) {
  std::vector<int> changed;
  for (size_t i = 0; i < items.size(); ++i) {
    const int node = items[i].node;
    if (node >= 0 && move(items[i], pose.world_from_node[node], rest)) changed.push_back(int(i));
  }
  return changed;
}

// `before` is empty if the present shapes are unknown: then all are recomputed.
std::vector<int> deform_meshes(Scene& scene, const Pose& pose, const std::optional<Pose>& before,
                               std::optional<double> seconds) {
  std::vector<int> changed;
  for (const DeformingMesh& shape : scene.rig->meshes) {
    const ShapeInputs inputs = inputs_of(*scene.rig, shape, pose);
    if (before && inputs == inputs_of(*scene.rig, shape, *before)) continue;
    update_mesh(*scene.rig, shape, inputs, seconds, scene.meshes[shape.mesh]);
    changed.push_back(shape.mesh);
  }
  return changed;
}

}  // namespace

SceneChanges set_time(Scene& scene, std::optional<double> seconds, int animation) {
  if (seconds && !std::isfinite(*seconds)) {
    throw input_error("{}: time {} is not a finite number of seconds", scene.name, *seconds);
  }
  check_animation(scene, animation);
  if (!scene.rig) return {};
  const Pose pose = pose_at(*scene.rig, seconds, animation);
  std::optional<Pose> before;
  const bool known = !scene.time_s || !std::isnan(*scene.time_s);
  if (known) before = pose_at(*scene.rig, scene.time_s, scene.animation);

  // Meshes first: only they can fail, and the next call then recomputes and lists all of them.
  scene.time_s = std::numeric_limits<double>::quiet_NaN();
  SceneChanges changes;
  changes.meshes = deform_meshes(scene, pose, before, seconds);
  RestFallback rest(*scene.rig);
  changes.instances = move_instances(scene, pose);
  changes.lights =
      move_all(scene.lights, pose, rest, [&](Light& light, const glm::dmat4& world, RestFallback& at_rest) {
        const bool moved = move_light(light, world, at_rest);
        return switch_light(*scene.rig, pose, light) || moved;
      });
  changes.cameras = move_all(scene.cameras, pose, rest, move_camera);
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

double looped_time(const Scene& scene, double seconds, int animation) {
  const double duration = duration_of(scene, animation);
  if (!(seconds > duration) || duration == 0) return seconds;
  const double remainder = std::fmod(seconds, duration);
  return remainder == 0 ? duration : remainder;
}

int animation_count(const Scene& scene) { return scene.rig ? int(scene.rig->animations.size()) : 0; }

}  // namespace lightgrid
