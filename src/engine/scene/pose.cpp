#include "scene/pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "base/facing.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

// Part of a key: glTF stores in-tangent, value and out-tangent for cubic splines.
enum class KeyPart { in_tangent, value, out_tangent };

std::vector<double> key_part(const AnimationChannel& channel, size_t index, KeyPart part = KeyPart::value) {
  const size_t parts_per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const size_t offset = parts_per_key == 3 ? static_cast<size_t>(part) : 0;
  const auto first =
      channel.values.begin() + static_cast<long>((index * parts_per_key + offset) * channel.components);
  return {first, first + channel.components};
}

double length_of(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// `absent` if the length is 0: the spline between two opposite quaternions passes through 0.
std::vector<double> normalized_or(std::vector<double> v, const std::vector<double>& absent) {
  const double length = length_of(v);
  if (!(length > 1e-12)) return absent;
  for (double& x : v) x /= length;
  return v;
}

std::vector<double> weighted_sum(double a, const std::vector<double>& x, double b,
                                 const std::vector<double>& y) {
  std::vector<double> sum(x.size());
  for (size_t i = 0; i < sum.size(); ++i) sum[i] = a * x[i] + b * y[i];
  return sum;
}

// Appendix C.4.
std::vector<double> spherical(const std::vector<double>& from, const std::vector<double>& to, double t) {
  double dot = 0;
  for (size_t i = 0; i < from.size(); ++i) dot += from[i] * to[i];
  const double sign = dot < 0 ? -1 : 1;
  const double angle = std::acos(std::min(std::abs(dot), 1.0));
  const double sine = std::sin(angle);
  // Below this angle the chord differs from the arc by less than 1e-12.
  const bool is_small = sine < 1e-6;
  const double a = is_small ? 1 - t : std::sin(angle * (1 - t)) / sine;
  const double b = is_small ? t : std::sin(angle * t) / sine;
  return normalized_or(weighted_sum(a, from, sign * b, to), from);
}

// Appendix C.5. Tangents are per second, so they are scaled by the time between the keys.
std::vector<double> cubic(const AnimationChannel& channel, size_t index, double t, double seconds_between) {
  const double t2 = t * t, t3 = t2 * t;
  const std::vector<double> from =
      weighted_sum(2 * t3 - 3 * t2 + 1, key_part(channel, index), seconds_between * (t3 - 2 * t2 + t),
                   key_part(channel, index, KeyPart::out_tangent));
  const std::vector<double> to =
      weighted_sum(3 * t2 - 2 * t3, key_part(channel, index + 1), seconds_between * (t3 - t2),
                   key_part(channel, index + 1, KeyPart::in_tangent));
  return weighted_sum(1, from, 1, to);
}

std::vector<double> key_value(const AnimationChannel& channel, size_t index) {
  std::vector<double> value = key_part(channel, index);
  return channel.path == AnimatedPath::rotation ? normalized_or(value, value) : value;
}

// The value of an animation channel at a time (glTF 2.0, section 3.11 and appendix C). Before the first key:
// its value; after the last key: its value. Rotations are unit quaternions (x, y, z, w), interpolated along
// the shorter arc if linear. If keys share a time, the last of them applies from that time on.
std::vector<double> sample_channel(const AnimationChannel& channel, double seconds) {
  const std::vector<float>& times = channel.times;
  const auto next = std::upper_bound(times.begin(), times.end(), seconds);
  if (next == times.begin()) return key_value(channel, 0);
  const auto index = static_cast<size_t>(next - times.begin()) - 1;
  const std::vector<double> from = key_value(channel, index);
  if (next == times.end() || channel.interpolation == Interpolation::step) return from;

  const double start = times[index], seconds_between = times[index + 1] - start;
  const double t = (seconds - start) / seconds_between;
  const bool is_rotation = channel.path == AnimatedPath::rotation;
  if (channel.interpolation == Interpolation::cubic_spline) {
    const std::vector<double> value = cubic(channel, index, t, seconds_between);
    return is_rotation ? normalized_or(value, from) : value;
  }
  const std::vector<double> to = key_value(channel, index + 1);
  return is_rotation ? spherical(from, to, t) : weighted_sum(1 - t, from, t, to);
}

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
  if (is_of_light(channel.path)) {
    pose.lights[{channel.node, channel.path}] = value;
    return;
  }
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
    case AnimatedPath::visible:
      pose.hidden[channel.node] = value[0] == 0;
      break;
    default:
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

std::vector<char> hidden_at_rest(const Rig& rig) {
  std::vector<char> hidden;
  hidden.reserve(rig.nodes.size());
  for (const RigNode& node : rig.nodes) hidden.push_back(!node.visible);
  return hidden;
}

// A node under a hidden one is hidden too.
void inherit_hidden(const Rig& rig, std::vector<char>& hidden) {
  for (size_t i = 0; i < rig.nodes.size(); ++i)
    if (rig.nodes[i].parent >= 0 && hidden[size_t(rig.nodes[i].parent)]) hidden[i] = 1;
}

}  // namespace

Pose rest_pose(const Rig& rig) {
  Pose pose{world_matrices(rig, nullptr), {}, hidden_at_rest(rig), {}};
  inherit_hidden(rig, pose.hidden);
  return pose;
}

Pose animated_pose(const Rig& rig, double seconds, int animation) {
  std::vector<NodeTransform> transforms;
  transforms.reserve(rig.nodes.size());
  for (const RigNode& node : rig.nodes) transforms.push_back(node.rest);
  Pose pose;
  pose.hidden = hidden_at_rest(rig);
  for (size_t i = 0; i < rig.animations.size(); ++i) {
    if (animation >= 0 && static_cast<size_t>(animation) != i) continue;
    for (const AnimationChannel& channel : rig.animations[i].channels)
      apply_channel(channel, seconds, transforms, pose);
  }
  inherit_hidden(rig, pose.hidden);
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

bool is_thin(const glm::dmat4& world_from_node) {
  const glm::dmat3 m(world_from_node);
  const glm::dvec3 none(0);
  return glm::cross(m[0], m[1]) == none && glm::cross(m[1], m[2]) == none && glm::cross(m[2], m[0]) == none;
}

glm::dmat4 world_of_instance(const glm::dmat4& world_from_node) {
  return is_thin(world_from_node) ? point_at(world_from_node[3]) : world_from_node;
}

glm::dmat4 point_at(const glm::dvec3& position) {
  glm::dmat4 point{glm::dmat3(hidden_scale)};
  point[3] = glm::dvec4(position, 1);
  return point;
}

bool is_mirrored(const glm::dmat4& world_from_node) { return is_mirroring(glm::dmat3(world_from_node)); }

glm::dmat4 winding_matrix(bool mirrored) {
  return glm::scale(glm::dmat4(1), glm::dvec3(mirrored ? -1 : 1, 1, 1));
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
