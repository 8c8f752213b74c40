#include "scene/gltf/nodes.h"

#include <cmath>
#include <utility>

#include "scene/gltf/accessor.h"
#include "scene/pose.h"

namespace lightgrid::gltf {

int chosen_scene(const Document& doc, int scene) {
  const tinygltf::Model& model = doc.model;
  if (scene < 0) scene = model.defaultScene;
  if (scene < 0 && !model.scenes.empty()) scene = 0;
  if (scene >= 0 && static_cast<size_t>(scene) >= model.scenes.size())
    throw doc.error("scene {} was requested, but there are {}", scene, model.scenes.size());
  return scene;
}

namespace {

void check_length(const Document& doc, const std::vector<double>& values, size_t length,
                  const std::string& place, const char* what) {
  if (!values.empty() && values.size() != length)
    throw doc.error("{}: {} has {} numbers instead of {}", place, what, values.size(), length);
}

glm::dmat4 affine_matrix(const Document& doc, const std::vector<double>& values, const std::string& place) {
  glm::dmat4 out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = values[i];
  for (int column = 0; column < 4; ++column)
    if (std::abs(out[column].w - (column == 3)) > 1e-6)
      throw doc.error("{}: matrix has a last row other than 0 0 0 1", place);
  for (int column = 0; column < 4; ++column) out[column].w = column == 3;
  return out;
}

void read_node_transform(const Document& doc, const tinygltf::Node& node, const std::string& place,
                         PlacedNode& out) {
  check_length(doc, node.matrix, 16, place, "matrix");
  check_length(doc, node.translation, 3, place, "translation");
  check_length(doc, node.rotation, 4, place, "rotation");
  check_length(doc, node.scale, 3, place, "scale");
  if (!node.matrix.empty()) {
    out.matrix = affine_matrix(doc, node.matrix, place);
    return;
  }
  if (!node.translation.empty())
    out.transform.translation = {node.translation[0], node.translation[1], node.translation[2]};
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (!(length > 1e-12) || !std::isfinite(length))
      throw doc.error("{}: rotation is a quaternion of length {}", place, length);
    out.transform.rotation = q / length;
  }
  if (!node.scale.empty()) out.transform.scale = {node.scale[0], node.scale[1], node.scale[2]};
}

bool is_visible(const Document& doc, const tinygltf::Node& node, const std::string& place) {
  const tinygltf::Value* extension = find_extension(node.extensions, "KHR_node_visibility");
  if (!extension || !extension->Has("visible")) return true;
  const tinygltf::Value& visible = extension->Get("visible");
  if (!visible.IsBool()) throw doc.error("{}: KHR_node_visibility.visible is neither true nor false", place);
  return visible.Get<bool>();
}

std::vector<int> roots_of(Document& doc, int scene) {
  const tinygltf::Model& model = doc.model;
  scene = chosen_scene(doc, scene);
  if (scene >= 0) return model.scenes[scene].nodes;
  std::vector<char> is_child(model.nodes.size(), 0);
  for (size_t i = 0; i < model.nodes.size(); ++i)
    for (int child : model.nodes[i].children)
      checked(doc, is_child, child, node_label(doc, static_cast<int>(i)), "child") = 1;
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  if (roots.empty() && !is_child.empty()) throw doc.error("its nodes form cycles");
  if (!roots.empty()) doc.warn("no scene", "has no scenes: all its nodes are used");
  return roots;
}

}  // namespace

std::string node_label(const Document& doc, int node) {
  return label("node", node, doc.model.nodes[node].name);
}

void apply_extras(const Document& doc, int scene_index, Scene& scene) {
  const auto found = doc.extras.scenes.find(chosen_scene(doc, scene_index));
  if (found == doc.extras.scenes.end()) return;
  const SceneExtras& extras = found->second;
  scene.samples = extras.samples.value_or(scene.samples);
  scene.ambient = extras.ambient.value_or(scene.ambient);
  scene.background = extras.background.value_or(scene.background);
}

const PlacedExtras& extras_of(const std::map<int, PlacedExtras>& owners, int index) {
  static const PlacedExtras none;
  const auto found = owners.find(index);
  return found == owners.end() ? none : found->second;
}

std::vector<RigNode> rig_nodes(const Document& doc, const std::vector<PlacedNode>& nodes) {
  std::vector<RigNode> out;
  for (const PlacedNode& placed : nodes)
    out.push_back({.label = node_label(doc, placed.node),
                   .parent = placed.parent,
                   .rest = placed.transform,
                   .matrix = placed.matrix,
                   .visible = placed.visible});
  return out;
}

std::vector<PlacedNode> place_nodes(Document& doc, int scene) {
  struct Pending {
    int node, parent;
  };
  std::vector<Pending> pending;
  const std::vector<int> roots = roots_of(doc, scene);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) pending.push_back({*it, -1});
  std::vector<char> reached(doc.model.nodes.size(), 0);
  std::vector<PlacedNode> placed;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const std::string parent = next.parent < 0 ? "scene" : node_label(doc, placed[next.parent].node);
    const tinygltf::Node& node = checked(doc, doc.model.nodes, next.node, parent, "node");
    const std::string place = node_label(doc, next.node);
    if (std::exchange(reached[next.node], 1))
      throw doc.error("{}: is reached twice; nodes must form trees", place);
    PlacedNode& out = placed.emplace_back(PlacedNode{.node = next.node, .parent = next.parent});
    read_node_transform(doc, node, place, out);
    out.visible = is_visible(doc, node, place);
    const glm::dmat4 world_from_parent =
        next.parent < 0 ? glm::dmat4(1) : placed[next.parent].world_from_node;
    out.world_from_node = world_from_parent * (out.matrix ? *out.matrix : parent_from_node(out.transform));
    if (!is_finite(out.world_from_node)) throw doc.error("{}: its world matrix is not finite", place);
    const int index = static_cast<int>(placed.size()) - 1;
    for (auto it = node.children.rbegin(); it != node.children.rend(); ++it) pending.push_back({*it, index});
  }
  return placed;
}

namespace {

class InstanceReader {
 public:
  InstanceReader(Document& doc, const tinygltf::Value& attributes, std::string place)
      : doc_(doc), attributes_(attributes), place_(std::move(place)) {}

  std::vector<NodeTransform> read() {
    const size_t count = checked_count();
    if (count == 0) {
      doc_.warn("count 0", "{}: has 0 instances; draws nothing", place_);
      return {};
    }
    const auto moved = read_attribute("TRANSLATION", TINYGLTF_TYPE_VEC3);
    const auto turned = read_attribute("ROTATION", TINYGLTF_TYPE_VEC4);
    const auto scaled = read_attribute("SCALE", TINYGLTF_TYPE_VEC3);
    std::vector<NodeTransform> out(count);
    for (size_t i = 0; i < count; ++i) {
      if (moved) out[i].translation = vector_at(*moved, i);
      if (turned) out[i].rotation = rotation_at(*turned, i);
      if (scaled) out[i].scale = vector_at(*scaled, i);
    }
    return out;
  }

 private:
  const tinygltf::Accessor& accessor(const std::string& name) const {
    return checked(doc_, doc_.model.accessors, attributes_.Get(name).GetNumberAsInt(), place_, name.c_str());
  }

  // The count that all attributes share, the application's own among them.
  size_t checked_count() const {
    const std::vector<std::string> names = attributes_.Keys();
    const size_t count = accessor(names.front()).count;
    for (const std::string& name : names)
      if (accessor(name).count != count)
        throw doc_.error("{}: {} has {} elements, but {} has {}", place_, names.front(), count, name,
                         accessor(name).count);
    if (count > doc_.limits.max_instances)
      throw doc_.error("{}: has {} instances, more than {}", place_, count, doc_.limits.max_instances);
    return count;
  }

  std::optional<FloatArray> read_attribute(const char* name, int type) {
    if (!attributes_.Has(name)) return {};
    const tinygltf::Accessor& in = accessor(name);
    if (in.type != type)
      throw doc_.error("{}: {} is not of type {}", place_, name,
                       type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "VEC4");
    const bool is_small =
        in.componentType == TINYGLTF_COMPONENT_TYPE_BYTE || in.componentType == TINYGLTF_COMPONENT_TYPE_SHORT;
    const bool may_be_small = type == TINYGLTF_TYPE_VEC4 && in.normalized;
    if (in.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !(is_small && may_be_small))
      throw doc_.error("{}: {} has componentType {}{}; it must be float{}", place_, name, in.componentType,
                       in.normalized ? ", normalized" : "",
                       type == TINYGLTF_TYPE_VEC4 ? ", or a normalized byte or short" : "");
    return read_floats(doc_, attributes_.Get(name).GetNumberAsInt(), in.count, Normalize::as_accessor_says,
                       place_ + ": " + name);
  }

  static glm::dvec3 vector_at(const FloatArray& array, size_t i) {
    return {array.values[3 * i], array.values[3 * i + 1], array.values[3 * i + 2]};
  }

  glm::dquat rotation_at(const FloatArray& array, size_t i) const {
    const float* q = array.values.data() + 4 * i;
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    const double length = glm::length(rotation);
    if (!(length > 1e-12))
      throw doc_.error("{}: ROTATION: element {} is a quaternion of length {}", place_, i, length);
    return rotation / length;
  }

  Document& doc_;
  const tinygltf::Value& attributes_;
  std::string place_;
};

}  // namespace

std::optional<std::vector<NodeTransform>> read_instances(Document& doc, int index) {
  const tinygltf::Node& node = doc.model.nodes[index];
  const tinygltf::Value* extension = find_extension(node.extensions, "EXT_mesh_gpu_instancing");
  if (!extension || node.mesh < 0) return {};
  const std::string place = node_label(doc, index) + ": EXT_mesh_gpu_instancing";
  if (!extension->Has("attributes") || !extension->Get("attributes").IsObject() ||
      extension->Get("attributes").Keys().empty())
    throw doc.error("{}: has no attributes", place);
  if (node.skin >= 0) throw doc.error("{}: the node has a skin; skinned meshes have no instances", place);
  return InstanceReader(doc, extension->Get("attributes"), place).read();
}

}  // namespace lightgrid::gltf
