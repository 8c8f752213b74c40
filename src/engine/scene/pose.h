// The nodes of a rig at a time, and the matrices derived from them.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "scene/rig.h"

namespace lightgrid {

struct Pose {
  std::vector<glm::dmat4> world_from_node;     // one a node of the rig
  std::map<int, std::vector<double>> weights;  // by node, where morph weights are animated
  std::vector<char> hidden;                    // one per node: it or a node above it is not visible
  std::map<std::pair<int, AnimatedPath>, std::vector<double>>
      lights;  // animated properties, by the file's light
};

Pose rest_pose(const Rig& rig);

// Animation `animation`, or at -1 all of them, later ones overriding earlier ones. Throws Error(input) if
// interpolation gives a matrix or weight that is not finite.
Pose animated_pose(const Rig& rig, double seconds, int animation);

glm::dmat4 parent_from_node(const NodeTransform& transform);

bool is_finite(const glm::dmat4& m);

// True if the matrix maps everything to a line or a point: nothing is seen of it.
bool is_thin(const glm::dmat4& world_from_node);

// Instance::world_from_object for this node: the node's matrix. A thin one is replaced by a scale of 2^-40
// about the node's position: the instance covers no pixel, and its normal matrix stays finite.
glm::dmat4 world_of_instance(const glm::dmat4& world_from_node);

// That scale, which is also the matrix of a hidden instance.
glm::dmat4 point_at(const glm::dvec3& position);

// The node's -z as a unit vector (KHR_lights_punctual); empty if the node scales it to 0.
std::optional<glm::vec3> light_direction(const glm::dmat4& world_from_node);

// The node's matrix without scale and shear, direction first, then up; empty if the node scales an axis to 0.
std::optional<glm::dmat4> rigid_part(const glm::dmat4& world_from_node);

// Front faces are clockwise: the determinant is negative.
bool is_mirrored(const glm::dmat4& world_from_node);

// world_from_object of a skinned mesh: the identity, or x negated. It is its own inverse.
glm::dmat4 winding_matrix(bool mirrored);

// The world matrix of each joint times its inverse bind matrix.
std::vector<glm::dmat4> joint_matrices(const RigSkin& skin, const std::vector<glm::dmat4>& world_from_node);

}  // namespace lightgrid
