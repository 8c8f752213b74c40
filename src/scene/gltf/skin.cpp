#include "scene/gltf/skin.h"

#include "scene/gltf/accessor.h"

namespace lightgrid::gltf {

RigSkin read_skin(Document& doc, int index, const std::vector<PlacedNode>& nodes) {
  const std::string place = fmt::format("skin {}", index);
  const tinygltf::Skin& skin = checked(doc, doc.model.skins, index, "node", "skin");
  std::vector<int> place_of_node(doc.model.nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) place_of_node[nodes[i].node] = static_cast<int>(i);
  FloatArray inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    inverse_bind = read_floats(doc, skin.inverseBindMatrices, skin.joints.size() + 65536,
                               Normalize::as_accessor_says, place + ": inverseBindMatrices");
    if (inverse_bind.components != 16 || inverse_bind.count() < skin.joints.size())
      throw doc.error("{}: inverseBindMatrices has {} elements of {} components for {} joints", place,
                      inverse_bind.count(), inverse_bind.components, skin.joints.size());
  }
  if (skin.joints.empty()) throw doc.error("{}: has no joints", place);
  RigSkin out;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    out.joints.push_back(checked(doc, place_of_node, skin.joints[i], place, "joint"));
    if (out.joints.back() < 0) throw doc.error("{}: joint {} is not in the scene", place, skin.joints[i]);
    glm::dmat4& bind = out.inverse_binds.emplace_back(1);
    if (inverse_bind.components == 16)
      for (int c = 0; c < 16; ++c) bind[c / 4][c % 4] = inverse_bind.values[i * 16 + c];
  }
  return out;
}

void check_joints(const Document& doc, const RigSkin& skin, const SkinWeights& weights,
                  const std::string& place) {
  for (size_t i = 0; i < weights.joints.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (weights.weights[i][k] != 0 && weights.joints[i][k] >= skin.joints.size())
        throw doc.error("{}: vertex {}: joint {}, but the skin has {}", place, i / weights.sets,
                        weights.joints[i][k], skin.joints.size());
}

}  // namespace lightgrid::gltf
