#include "scene/gltf/skin.h"

#include <cmath>

namespace lightgrid::gltf {
namespace {

glm::vec3 unit_or_same(const glm::dvec3& v, const glm::vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

// The inverse transpose up to a factor, defined for singular matrices too.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

std::vector<glm::dmat4> joint_matrices(Document& doc, int index, const std::vector<PlacedNode>& nodes) {
  const std::string place = fmt::format("skin {}", index);
  const tinygltf::Skin& skin = checked(doc, doc.model.skins, index, "node", "skin");
  std::vector<const glm::dmat4*> world_of_node(doc.model.nodes.size(), nullptr);
  for (const PlacedNode& placed : nodes) world_of_node[placed.node] = &placed.world_from_node;
  FloatArray inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    inverse_bind = read_floats(doc, skin.inverseBindMatrices, skin.joints.size() + 65536,
                               Normalize::as_accessor_says, place + ": inverseBindMatrices");
    if (inverse_bind.components != 16 || inverse_bind.count() < skin.joints.size())
      throw doc.error("{}: inverseBindMatrices has {} elements of {} components for {} joints", place,
                      inverse_bind.count(), inverse_bind.components, skin.joints.size());
  }
  std::vector<glm::dmat4> out;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    const glm::dmat4* world = checked(doc, world_of_node, skin.joints[i], place, "joint");
    if (!world) throw doc.error("{}: joint {} is not in the scene", place, skin.joints[i]);
    glm::dmat4 bind(1);
    if (inverse_bind.components == 16)
      for (int c = 0; c < 16; ++c) bind[c / 4][c % 4] = inverse_bind.values[i * 16 + c];
    out.push_back(*world * bind);
  }
  return out;
}

void apply_skin(const Document& doc, const std::vector<glm::dmat4>& joints, const SkinWeights& skin,
                const std::string& place, Mesh& mesh) {
  for (size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    glm::dmat4 blend(0);
    double sum = 0;
    for (int k = 0; k < skin.sets * 4; ++k) {
      const size_t at = vertex * skin.sets + k / 4;
      const double weight = skin.weights[at][k % 4];
      if (weight == 0) continue;
      const uint32_t joint = skin.joints[at][k % 4];
      if (joint >= joints.size())
        throw doc.error("{}: vertex {}: joint {}, but the skin has {}", place, vertex, joint, joints.size());
      blend += joints[joint] * weight;
      sum += weight;
    }
    if (!(sum > 0)) blend = glm::dmat4(1), sum = 1;  // weighted by nothing: stays where the file has it
    blend /= sum;
    glm::vec3& position = mesh.positions[vertex];
    position = glm::vec3(blend * glm::dvec4(position, 1));
    if (!std::isfinite(position.x + position.y + position.z))
      throw doc.error("{}: vertex {} is moved to infinity by its joints", place, vertex);
    const glm::dmat3 turn(blend);
    if (!mesh.normals.empty())
      mesh.normals[vertex] =
          unit_or_same(cofactors(turn) * glm::dvec3(mesh.normals[vertex]), mesh.normals[vertex]);
    if (mesh.tangents.empty()) continue;
    const glm::vec3 tangent(mesh.tangents[vertex]);
    mesh.tangents[vertex] =
        glm::vec4(unit_or_same(turn * glm::dvec3(tangent), tangent), mesh.tangents[vertex].w);
  }
}

}  // namespace lightgrid::gltf
