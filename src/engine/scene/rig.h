// The moving parts of a scene: the nodes, animations, skins and morph targets of a glTF file (glTF 2.0,
// Khronos, 2021, sections 3.5, 3.7.2.2, 3.7.3 and 3.11). Plain data that never changes after loading;
// scene/animation.h applies it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "scene/scene.h"

namespace lightgrid {

// Object space of the node to that of its parent: translation * rotation * scale.
struct NodeTransform {
  glm::dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};  // unit
  glm::dvec3 scale{1};
};

struct RigNode {
  std::string label;                 // for messages: node 3 "arm"
  int parent = -1;                   // an earlier node; -1: a root
  NodeTransform rest;                // used unless an animation moves it
  std::optional<glm::dmat4> matrix;  // affine; replaces `rest`: such a node cannot be animated
  bool visible = true;               // at rest, KHR_node_visibility; a node under a hidden one is hidden too
};

enum class AnimatedPath {
  translation,
  rotation,
  scale,
  weights,
  visible,
  color,  // this and all below: of a light
  intensity,
  range,
  inner_cone,
  outer_cone
};
inline bool is_of_light(AnimatedPath path) { return path >= AnimatedPath::color; }

// A light that is hidden or shown, or whose properties are animated.
struct RigLight {
  int light = 0;  // light number in the file
  Light rest;
};
enum class Interpolation { linear, step, cubic_spline };

// One animated property of one node, or of all lights that are one light of the file.
struct AnimationChannel {
  int node = 0;  // or the light of the file
  AnimatedPath path = AnimatedPath::translation;
  Interpolation interpolation = Interpolation::linear;
  int components = 3;  // translation, scale and color 3, rotation 4 (x, y, z, w), weights: one for each morph
                       // target; others 1
  std::vector<float> times;  // seconds, from 0 on, not decreasing; at least one
  // `components` for each time; for cubic_spline in-tangent, value and out-tangent, `components` each.
  std::vector<float> values;
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;  // channels that move a node of this scene
};

struct RigSkin {
  std::vector<int> joints;                // nodes
  std::vector<glm::dmat4> inverse_binds;  // one a joint
};

// Displacements of each vertex at weight 1. Empty if the target does not displace this attribute.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;
};

struct SkinWeights {
  int sets = 0;                    // sets of four joints per vertex; 0: not skinned
  std::vector<glm::uvec4> joints;  // joints[vertex * sets + set], into RigSkin::joints
  std::vector<glm::vec4> weights;
};

// The tangents that a mesh needs: none, or the file's, or (if it has none) tangents along u of a texture
// coordinate set.
enum class TangentNeed { none, along_uv0, along_uv1 };

// The shape to which morph targets and joints apply. Only meshes that deform have one.
struct DeformingMesh {
  int mesh = 0;  // index in Scene::meshes of the result
  std::string label;
  Mesh base;  // as in the file; normals and tangents may be missing
  TangentNeed tangents = TangentNeed::none;
  int weights_node = -1;             // the node with the morph weights; -1: base is already morphed
  std::vector<double> rest_weights;  // one a target, or none: all 0
  std::vector<MorphTarget> targets;
  int skin = -1;  // index into Rig::skins; -1: not skinned
  SkinWeights skin_weights;
  // A skinned mesh ignores the node that draws it, except that a negative determinant makes front faces
  // clockwise (glTF 2.0, section 3.7.4). Such a mesh is stored mirrored, in the space of winding_matrix.
  bool mirrored = false;  // at rest
  int winding_node = -1;  // the node that draws it, if it moves; only this node draws the mesh
};

struct Rig {
  std::string file;                   // for messages
  std::vector<RigNode> nodes;         // parents before children
  std::vector<Animation> animations;  // all of the file, by its index
  std::vector<RigSkin> skins;         // all of the file, by its index; those that deform nothing are empty
  std::vector<DeformingMesh> meshes;
  std::map<int, RigLight> lights;  // by their node
};

}  // namespace lightgrid
