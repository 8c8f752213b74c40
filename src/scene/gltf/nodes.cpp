#include "scene/gltf/nodes.h"

#include <cmath>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace lightgrid::gltf {
namespace {

void check_length(const Document& doc, const std::vector<double>& values, size_t length,
                  const std::string& place, const char* what) {
  if (!values.empty() && values.size() != length)
    throw doc.error("{}: {} has {} numbers instead of {}", place, what, values.size(), length);
}

bool is_finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

glm::dmat4 parent_from_node(const Document& doc, const tinygltf::Node& node, const std::string& place) {
  check_length(doc, node.matrix, 16, place, "matrix");
  check_length(doc, node.translation, 3, place, "translation");
  check_length(doc, node.rotation, 4, place, "rotation");
  check_length(doc, node.scale, 3, place, "scale");
  glm::dmat4 out(1);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = node.matrix[i];
    for (int column = 0; column < 4; ++column)
      if (std::abs(out[column].w - (column == 3)) > 1e-6)
        throw doc.error("{}: matrix has a last row other than 0 0 0 1", place);
    for (int column = 0; column < 4; ++column) out[column].w = column == 3;
    return out;
  }
  if (!node.translation.empty())
    out = glm::translate(out, {node.translation[0], node.translation[1], node.translation[2]});
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (!(length > 1e-12) || !std::isfinite(length))
      throw doc.error("{}: rotation is a quaternion of length {}", place, length);
    out *= glm::mat4_cast(q / length);
  }
  if (!node.scale.empty()) out = glm::scale(out, {node.scale[0], node.scale[1], node.scale[2]});
  return out;
}

std::vector<int> roots_of(Document& doc, int scene) {
  const tinygltf::Model& model = doc.model;
  if (scene < 0) scene = model.defaultScene;
  if (scene < 0 && !model.scenes.empty()) scene = 0;
  if (scene >= 0 && static_cast<size_t>(scene) >= model.scenes.size())
    throw doc.error("scene {} was asked for, but there are {}", scene, model.scenes.size());
  if (scene >= 0) return model.scenes[scene].nodes;
  std::vector<char> is_child(model.nodes.size(), 0);
  for (size_t i = 0; i < model.nodes.size(); ++i)
    for (int child : model.nodes[i].children)
      checked(doc, is_child, child, node_label(doc, static_cast<int>(i)), "child") = 1;
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  if (roots.empty() && !is_child.empty()) throw doc.error("its nodes are all children of each other");
  if (!roots.empty()) doc.warn("no scene", "has no scenes: all its nodes are used");
  return roots;
}

}  // namespace

std::string node_label(const Document& doc, int node) {
  return label("node", node, doc.model.nodes[node].name);
}

std::vector<PlacedNode> place_nodes(Document& doc, int scene) {
  struct Pending {
    int node, depth;
    glm::dmat4 world_from_parent;
    std::string parent;
  };
  std::vector<Pending> pending;
  const std::vector<int> roots = roots_of(doc, scene);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it)
    pending.push_back({*it, 1, glm::dmat4(1), "scene"});
  std::vector<char> reached(doc.model.nodes.size(), 0);
  std::vector<PlacedNode> placed;
  while (!pending.empty()) {
    const Pending next = std::move(pending.back());
    pending.pop_back();
    const tinygltf::Node& node = checked(doc, doc.model.nodes, next.node, next.parent, "node");
    const std::string place = node_label(doc, next.node);
    if (std::exchange(reached[next.node], 1))
      throw doc.error("{}: is reached twice; nodes must form trees", place);
    if (next.depth > doc.limits.max_node_depth)
      throw doc.error("{}: is more than {} nodes deep", place, doc.limits.max_node_depth);
    const glm::dmat4 world = next.world_from_parent * parent_from_node(doc, node, place);
    if (!is_finite(world)) throw doc.error("{}: its world matrix is not finite", place);
    placed.push_back({next.node, world});
    for (auto it = node.children.rbegin(); it != node.children.rend(); ++it)
      pending.push_back({*it, next.depth + 1, world, place});
  }
  return placed;
}

}  // namespace lightgrid::gltf
