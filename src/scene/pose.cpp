#include "scene/pose.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/keyframes.h"

namespace lightgrid {
namespace {

std::vector<glm::dmat4> world_matrices(const Rig& rig, const std::vector<NodeTransform>* moved) {
  std::vector<glm::dmat4> world;
  world.reserve(rig.nodes.size());
  for (size_t i = 0; i < rig.nodes.size(); ++i) {
    const RigNode& node = rig.nodes[i];
    const glm::dmat4 local = node.matrix ? *node.matrix : parent_from_node(moved ? (*moved)[i] : node.rest);
    world.push_back((node.parent < 0 ? glm::dmat4(1) : world[node.parent]) * local);
  }
  return world;
}

void apply_channel(const AnimationChannel& channel, double seconds, std::vector<NodeTransform>& transforms,
                   Pose& pose) {
  const std::vector<double> value = sample_channel(channel, seconds);
  NodeTransform& transform = transforms[channel.node];
  switch (channel.path) {
    case AnimatedPath::translation:
      transform.translation = {value[0], value[1], value[2]};
      break;
    case AnimatedPath::rotation:
      transform.rotation = glm::dquat(value[3], value[0], value[1], value[2]);
      break;
    case AnimatedPath::scale:
      transform.scale = {value[0], value[1], value[2]};
      break;
    case AnimatedPath::weights:
      pose.weights[channel.node] = value;
      break;
  }
}

void check_finite(const Rig& rig, const Pose& pose, double seconds) {
  for (size_t i = 0; i < rig.nodes.size(); ++i) {
    if (!is_finite(pose.world_from_node[i])) {
      throw input_error("{}: {}: its world matrix at {} s is not finite", rig.file, rig.nodes[i].label,
                        seconds);
    }
  }
  for (const auto& [node, weights] : pose.weights) {
    for (const double weight : weights) {
      if (!std::isfinite(weight)) {
        throw input_error("{}: {}: a morph weight at {} s is {}", rig.file, rig.nodes[node].label, seconds,
                          weight);
      }
    }
  }
}

}  // namespace

Pose rest_pose(const Rig& rig) { return {world_matrices(rig, nullptr), {}}; }

Pose animated_pose(const Rig& rig, double seconds, int animation) {
  std::vector<NodeTransform> transforms;
  transforms.reserve(rig.nodes.size());
  for (const RigNode& node : rig.nodes) transforms.push_back(node.rest);
  Pose pose;
  for (size_t i = 0; i < rig.animations.size(); ++i) {
    if (animation >= 0 && static_cast<size_t>(animation) != i) continue;
    for (const AnimationChannel& channel : rig.animations[i].channels)
      apply_channel(channel, seconds, transforms, pose);
  }
  pose.world_from_node = world_matrices(rig, &transforms);
  check_finite(rig, pose, seconds);
  return pose;
}

glm::dmat4 parent_from_node(const NodeTransform& transform) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1), transform.translation);
  return glm::scale(moved * glm::mat4_cast(transform.rotation), transform.scale);
}

bool is_finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}

bool is_flat(const glm::dmat4& world_from_node) { return glm::determinant(glm::dmat3(world_from_node)) == 0; }

glm::dmat4 world_of_instance(const glm::dmat4& world_from_node) {
  if (!is_flat(world_from_node)) return world_from_node;
  glm::dmat4 point(glm::dmat3(0x1p-40));
  point[3] = world_from_node[3];
  return point;
}

std::optional<glm::vec3> light_direction(const glm::dmat4& world_from_node) {
  const glm::dvec3 along = -glm::dvec3(world_from_node[2]);
  const double length = glm::length(along);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return glm::vec3(along / length);
}

std::optional<glm::dmat4> rigid_part(const glm::dmat4& world_from_node) {
  const glm::dvec3 back(world_from_node[2]), up(world_from_node[1]);
  const glm::dvec3 z = back / glm::length(back);
  const glm::dvec3 across = up - z * glm::dot(up, z);
  const glm::dvec3 y = across / glm::length(across);
  if (!std::isfinite(z.x + z.y + z.z + y.x + y.y + y.z)) return {};
  return glm::dmat4(glm::dvec4(glm::cross(y, z), 0), glm::dvec4(y, 0), glm::dvec4(z, 0), world_from_node[3]);
}

std::vector<glm::dmat4> joint_matrices(const RigSkin& skin, const std::vector<glm::dmat4>& world_from_node) {
  std::vector<glm::dmat4> out;
  out.reserve(skin.joints.size());
  for (size_t i = 0; i < skin.joints.size(); ++i)
    out.push_back(world_from_node[skin.joints[i]] * skin.inverse_binds[i]);
  return out;
}

}  // namespace lightgrid
