// The nodes of one scene, flattened, and what they hold: copies (EXT_mesh_gpu_instancing), animations
// (glTF 2.0, section 3.11), meshes, lights (KHR_lights_punctual, Khronos, 2018) and cameras.
#pragma once

#include <optional>

#include "scene/gltf/document.h"
#include "scene/rig.h"
#include "scene/scene.h"

namespace lightgrid::gltf {

struct PlacedNode {
  int node = 0;     // index in the file
  int parent = -1;  // index in the flattened array; -1: a root
  NodeTransform transform;
  std::optional<glm::dmat4> matrix;  // replaces `transform`
  glm::dmat4 world_from_node{1};     // at rest
  bool visible = true;               // its own property (KHR_node_visibility)
  bool off = false;                  // hidden at all times, by itself or an ancestor; set by read_animations
  bool blinks = false;               // an animation shows or hides it or an ancestor; set by read_animations
  bool moves = false;   // it blinks, or an animation moves this node or an ancestor; set by read_animations
  bool scales = false;  // an animation scales this node or an ancestor; set by read_animations
  bool morphs = false;  // an animation sets its morph weights; set by read_animations
};

// Depth first, in the file's order. `scene` -1: the file's default, else its first scene, else (a file
// without scenes) all root nodes. Errors: an index out of range, a node reached twice (which covers cycles),
// a matrix that is not finite or not affine.
std::vector<PlacedNode> place_nodes(Document& doc, int scene);

// The number of that scene; -1: the file has no scenes. Errors: an index out of range.
int chosen_scene(const Document& doc, int scene);

// Sets the scene's samples, ambient and background, as far as that scene of the file has them.
void apply_extras(const Document& doc, int scene_index, Scene& scene);

// `owners`: of Document::extras, nodes or lights. Without an entry: no field has a value.
const PlacedExtras& extras_of(const std::map<int, PlacedExtras>& owners, int index);

// The same nodes as rig nodes.
std::vector<RigNode> rig_nodes(const Document& doc, const std::vector<PlacedNode>& nodes);

std::string node_label(const Document& doc, int node);

// Each copy's place relative to the node, by the node's index in the file; empty if the node is not
// instanced. Errors: no attributes, attributes of unequal count or of a type that the extension does not
// have, more than limits.max_instances, a rotation of length 0, a skin.
std::optional<std::vector<NodeTransform>> read_instances(Document& doc, int node);

// All animations of the file, each with the channels that move a node of `nodes`. AnimationChannel::node is
// an index into `nodes`, or a light of the file; the function sets their `moves`, `scales`, `morphs`,
// `blinks` and `off`. Channels without a node, and of nodes outside the scene, are omitted; so are (with a
// warning) paths not in glTF 2.0, pointers (KHR_animation_pointer) to properties that AnimatedPath does not
// have, and weights of a node without morph targets. An animation with a fault has no channels: one warning
// names the first, its fault and the number of others. Faults: broken JSON or indices; two channels of one
// animation with the same target; translation, rotation or scale of a node with a matrix; a missing sampler;
// times that are not float scalars, negative or decreasing; values of another type or number than the
// target's; an unknown interpolation; a cubic spline of one key; a rotation of length 0; more values than
// limits.max_animation_values.
std::vector<Animation> read_animations(Document& doc, std::vector<PlacedNode>& nodes);

// Adds to `scene` the meshes that the nodes use, at rest, one for each combination of skin and morph weights
// (a node with animated weights has its own), and an instance for each use. Adds to `rig` the skins, and the
// shapes of those meshes that animated joints or weights deform; no other mesh is stored twice. Materials
// must be read already: a mesh refers to the file's material index (the default one at the end).
// Returns the node of the file that each instance belongs to.
std::vector<int> add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene, Rig& rig);

// One light for each node with one. A light points along its node's -z; the node's scale changes neither
// range nor cone. Lights without a node are not read, lights of an unknown type are left out; a negative
// colour or intensity counts as 0 and a range of 0 or less as none, each with a warning. Errors name light
// and field: values that are not finite, their product past the largest float. Adds to `given` the properties
// in the lights' extras, a node's before its light's, and to `rig` the lights that its animations switch or
// change.
std::vector<Light> read_lights(Document& doc, const std::vector<PlacedNode>& nodes, GivenByFile& given,
                               Rig& rig);

// Adds one point light for each node with an extension of light_extensions(), and one rectangle for each with
// EXT_lights_area.
void add_extension_lights(Document& doc, const std::vector<PlacedNode>& nodes, GivenByFile& given, Rig& rig,
                          std::vector<Light>& lights);

// The properties in the extras of instances' nodes.
std::vector<GivenProperties> properties_of_instances(const Document& doc,
                                                     const std::vector<int>& node_of_instance);

// One camera for each node with one; the node's scale is dropped. A camera with a fault is left out: one
// warning names the first, its fault and the number of others.
std::vector<Camera> read_cameras(Document& doc, const std::vector<PlacedNode>& nodes);

}  // namespace lightgrid::gltf
