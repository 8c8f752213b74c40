#include "scene/gltf/nodes.h"

#include <algorithm>

#include "scene/deform.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/primitive.h"
#include "scene/pose.h"

namespace lightgrid::gltf {
namespace {

// Joints as places in the rig, -1 for a node of the file that is not in the scene, and their inverse bind
// matrices (identities if the file has none).
RigSkin read_skin(Document& doc, int index, const std::vector<int>& place_of_node) {
  const std::string place = fmt::format("skin {}", index);
  const tinygltf::Skin& skin = checked(doc, doc.model.skins, index, "node", "skin");
  FloatArray inverse_bind;
  if (skin.inverseBindMatrices >= 0 &&
      !is_empty_accessor(doc, skin.inverseBindMatrices, place + ": inverseBindMatrices")) {
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

// Throws an error if a vertex has a weight for a joint that the skin does not have.
void check_joints(const Document& doc, const RigSkin& skin, const SkinWeights& weights,
                  const std::string& place) {
  for (size_t i = 0; i < weights.joints.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (weights.weights[i][k] != 0 && weights.joints[i][k] >= skin.joints.size())
        throw doc.error("{}: vertex {}: joint {}, but the skin has {}", place, i / weights.sets,
                        weights.joints[i][k], skin.joints.size());
}

class MeshReader {
 public:
  MeshReader(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene, Rig& rig)
      : doc_(doc), nodes_(nodes), scene_(scene), rig_(rig), budget_(doc.limits.max_vertices) {
    place_of_node_.resize(doc.model.nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); ++i) {
      world_from_node_.push_back(nodes[i].world_from_node);
      place_of_node_[nodes[i].node] = static_cast<int>(i);
    }
    rig_.skins.resize(doc.model.skins.size());
    joints_at_rest_.resize(doc.model.skins.size());
  }

  void add(int index) {
    const PlacedNode& placed = nodes_[index];
    const tinygltf::Node& node = doc_.model.nodes[placed.node];
    if (node.mesh < 0 || placed.off) return;
    const std::string place = node_label(doc_, placed.node);
    const tinygltf::Mesh& mesh = checked(doc_, doc_.model.meshes, node.mesh, place, "mesh");
    if (node.skin >= 0) checked(doc_, doc_.model.skins, node.skin, place, "skin");
    const Use use{node.mesh,
                  node.skin,
                  default_weights(doc_, node, mesh, place),
                  placed.morphs ? index : -1,
                  node.skin >= 0 && is_mirrored(placed.world_from_node),
                  node.skin >= 0 && (placed.scales || placed.blinks) ? index : -1};
    const std::vector<Drawn>& meshes = meshes_of(use);
    casts_shadow_ = extras_of(doc_.extras.nodes, placed.node).casts_shadow.value_or(true);
    file_node_ = placed.node;
    if (const auto copies = read_instances(doc_, placed.node)) return add_copies(index, meshes, *copies);
    for (const Drawn& drawn : meshes)
      add_instance(drawn, node.name, place, placed.world_from_node, placed.moves ? index : -1);
  }

  std::vector<int> take_nodes() { return std::move(node_of_instance_); }

 private:
  struct Drawn {
    int mesh;      // mesh number in the scene
    bool skinned;  // its joints place it
    int winding_node;
  };

  // The inputs that determine the shape of a file's mesh.
  struct Use {
    int mesh, skin;               // numbers in the file
    std::vector<double> weights;  // at rest
    int weights_node;             // a place in nodes_, where the weights are animated; else -1
    bool mirrored;                // DeformingMesh has both
    int winding_node;
    auto operator<=>(const Use&) const = default;
  };

  // `node`: of the rig, which moves the instance, or -1.
  void add_instance(const Drawn& drawn, const std::string& name, const std::string& place,
                    const glm::dmat4& world_from_node, int node) {
    if (!drawn.skinned && node < 0 && is_thin(world_from_node)) {
      doc_.warn("thin", "{}: is scaled to a line or a point and left out", place);
      return;
    }
    if (scene_.instances.size() >= doc_.limits.max_instances)
      throw doc_.error("{}: more than {} instances", place, doc_.limits.max_instances);
    scene_.instances.push_back({.name = name,
                                .mesh = drawn.mesh,
                                .world_from_object = drawn.skinned
                                                         ? winding_matrix(is_mirrored(world_from_node))
                                                         : world_of_instance(world_from_node),
                                .node = drawn.skinned ? drawn.winding_node : node,
                                .casts_shadow = casts_shadow_});
    node_of_instance_.push_back(file_node_);
  }

  // The copies of a node that moves are children of it in the rig.
  void add_copies(int index, const std::vector<Drawn>& meshes, const std::vector<NodeTransform>& copies) {
    const PlacedNode& placed = nodes_[index];
    const std::string& name = doc_.model.nodes[placed.node].name;
    for (size_t i = 0; i < copies.size(); ++i) {
      const std::string place = fmt::format("{} instance {}", node_label(doc_, placed.node), i);
      const glm::dmat4 world = placed.world_from_node * parent_from_node(copies[i]);
      if (!is_finite(world)) throw doc_.error("{}: its world matrix is not finite", place);
      int node = -1;
      if (placed.moves) {
        node = static_cast<int>(rig_.nodes.size());
        rig_.nodes.push_back({.label = place, .parent = index, .rest = copies[i], .matrix = {}});
      }
      for (const Drawn& drawn : meshes) add_instance(drawn, name, place, world, node);
    }
  }

  const std::vector<Drawn>& meshes_of(const Use& use) {
    const auto [known, is_new] = drawn_.try_emplace(use);
    if (is_new) known->second = read(use);
    return known->second;
  }

  std::vector<Drawn> read(const Use& use) {
    const tinygltf::Mesh& in = doc_.model.meshes[use.mesh];
    std::vector<Drawn> out;
    for (size_t i = 0; i < in.primitives.size(); ++i) {
      const std::string place = fmt::format("{} primitive {}", label("mesh", use.mesh, in.name), i);
      auto primitive = read_primitive(doc_, in.primitives[i], scene_.materials, budget_, place);
      if (!primitive) continue;
      primitive->mesh.name = in.name;
      const bool skinned = use.skin >= 0 && primitive->skin.sets > 0;
      out.push_back({static_cast<int>(scene_.meshes.size()), skinned, use.winding_node});
      DeformingMesh shape{.mesh = out.back().mesh,
                          .label = place,
                          .tangents = tangent_need(scene_.materials[primitive->mesh.material])};
      if (skinned) {
        shape.skin = use.skin;
        shape.skin_weights = std::move(primitive->skin);
        shape.mirrored = use.mirrored;
        shape.winding_node = use.winding_node;
      }
      add_at_rest(in.primitives[i], use, std::move(primitive->mesh), std::move(shape));
    }
    return out;
  }

  // Adds the mesh at rest to the scene, and its shape to the rig if it deforms.
  void add_at_rest(const tinygltf::Primitive& in, const Use& use, Mesh mesh, DeformingMesh shape) {
    const bool morphs = use.weights_node >= 0 && !in.targets.empty();
    std::vector<MorphTarget> targets =
        read_morph_targets(doc_, in, use.weights, morphs, mesh, budget_, shape.label);
    if (!morphs) apply_checked_morph(targets, use.weights, shape.label, mesh);
    if (shape.tangents == TangentNeed::none) mesh.tangents = {};
    const bool deforms = morphs || shape.winding_node >= 0 || (shape.skin >= 0 && moves(skin_of(shape.skin)));
    if (deforms) shape.base = mesh;
    if (morphs) apply_checked_morph(targets, use.weights, shape.label, mesh);
    if (shape.skin >= 0) apply_checked_skin(shape, mesh);
    spend_on_flat_normals(doc_, mesh, budget_, shape.label);
    complete_mesh(shape.tangents, mesh);
    scene_.meshes.push_back(std::move(mesh));
    if (!deforms) return;
    if (morphs) {
      shape.weights_node = use.weights_node;
      shape.rest_weights = use.weights;
      shape.targets = std::move(targets);
    }
    rig_.meshes.push_back(std::move(shape));
  }

  void apply_checked_morph(const std::vector<MorphTarget>& targets, const std::vector<double>& weights,
                           const std::string& place, Mesh& mesh) const {
    if (targets.empty()) return;
    apply_morph_targets(targets, weights, mesh);
    if (first_not_finite(mesh)) throw doc_.error("{}: its morph targets move a vertex to infinity", place);
  }

  void apply_checked_skin(const DeformingMesh& shape, Mesh& mesh) {
    const RigSkin& skin = skin_of(shape.skin);
    check_joints(doc_, skin, shape.skin_weights, shape.label);
    std::vector<glm::dmat4>& joints = joints_at_rest_[size_t(shape.skin)];
    if (joints.empty()) joints = joint_matrices(skin, world_from_node_);
    apply_skin(joints, shape.skin_weights, shape.mirrored, mesh);
    if (const auto vertex = first_not_finite(mesh))
      throw doc_.error("{}: vertex {} is moved to infinity by its joints", shape.label, *vertex);
  }

  const RigSkin& skin_of(int skin) {
    if (rig_.skins[skin].joints.empty()) rig_.skins[skin] = read_skin(doc_, skin, place_of_node_);
    return rig_.skins[skin];
  }

  bool moves(const RigSkin& skin) const {
    return std::any_of(skin.joints.begin(), skin.joints.end(),
                       [&](int joint) { return nodes_[joint].moves; });
  }

  Document& doc_;
  const std::vector<PlacedNode>& nodes_;
  Scene& scene_;
  Rig& rig_;
  bool casts_shadow_ = true;  // the node whose instances are added
  int file_node_ = 0;         // the same node
  std::vector<int> node_of_instance_;
  Budget budget_;
  std::vector<int> place_of_node_;
  std::vector<glm::dmat4> world_from_node_;
  std::vector<std::vector<glm::dmat4>> joints_at_rest_;  // by skin; empty until they are used
  std::map<Use, std::vector<Drawn>> drawn_;
};

}  // namespace

std::vector<int> add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene, Rig& rig) {
  MeshReader reader(doc, nodes, scene, rig);
  for (size_t i = 0; i < nodes.size(); ++i) reader.add(static_cast<int>(i));
  return reader.take_nodes();
}

}  // namespace lightgrid::gltf
