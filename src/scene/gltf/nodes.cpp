#include "scene/gltf/nodes.h"

#include <cmath>
#include <utility>

#include "scene/pose.h"

namespace lightgrid::gltf {
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

std::vector<int> roots_of(Document& doc, int scene) {
  const tinygltf::Model& model = doc.model;
  if (scene < 0) scene = model.defaultScene;
  if (scene < 0 && !model.scenes.empty()) scene = 0;
  if (scene >= 0 && static_cast<size_t>(scene) >= model.scenes.size())
    throw doc.error("scene {} was requested, but there are {}", scene, model.scenes.size());
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

std::vector<RigNode> rig_nodes(const Document& doc, const std::vector<PlacedNode>& nodes) {
  std::vector<RigNode> out;
  for (const PlacedNode& placed : nodes)
    out.push_back({.label = node_label(doc, placed.node),
                   .parent = placed.parent,
                   .rest = placed.transform,
                   .matrix = placed.matrix});
  return out;
}

std::vector<PlacedNode> place_nodes(Document& doc, int scene) {
  struct Pending {
    int node, parent, depth;
  };
  std::vector<Pending> pending;
  const std::vector<int> roots = roots_of(doc, scene);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it) pending.push_back({*it, -1, 1});
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
    if (next.depth > doc.limits.max_node_depth)
      throw doc.error("{}: is more than {} nodes deep", place, doc.limits.max_node_depth);
    PlacedNode& out = placed.emplace_back(PlacedNode{.node = next.node, .parent = next.parent});
    read_node_transform(doc, node, place, out);
    const glm::dmat4 world_from_parent =
        next.parent < 0 ? glm::dmat4(1) : placed[next.parent].world_from_node;
    out.world_from_node = world_from_parent * (out.matrix ? *out.matrix : parent_from_node(out.transform));
    if (!is_finite(out.world_from_node)) throw doc.error("{}: its world matrix is not finite", place);
    const int index = static_cast<int>(placed.size()) - 1;
    for (auto it = node.children.rbegin(); it != node.children.rend(); ++it)
      pending.push_back({*it, index, next.depth + 1});
  }
  return placed;
}

}  // namespace lightgrid::gltf
