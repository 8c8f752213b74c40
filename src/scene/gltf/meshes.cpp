#include "scene/gltf/meshes.h"

#include <tuple>

#include "scene/gltf/morph.h"
#include "scene/gltf/skin.h"

namespace lightgrid::gltf {
namespace {

class MeshReader {
 public:
  MeshReader(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene)
      : doc_(doc), nodes_(nodes), scene_(scene), budget_(doc.limits.max_vertices) {}

  void add(const PlacedNode& placed) {
    const tinygltf::Node& node = doc_.model.nodes[placed.node];
    if (node.mesh < 0) return;
    checked(doc_, doc_.model.meshes, node.mesh, node_label(doc_, placed.node), "mesh");
    if (node.skin >= 0) checked(doc_, doc_.model.skins, node.skin, node_label(doc_, placed.node), "skin");
    const std::vector<double> weights =
        default_weights(doc_, node, doc_.model.meshes[node.mesh], node_label(doc_, placed.node));
    for (const Drawn& drawn : meshes_of(node.mesh, node.skin, weights)) {
      // A mesh flattened to a plane, line or point has no normals that could be lit.
      if (!drawn.in_world && glm::determinant(glm::dmat3(placed.world_from_node)) == 0) {
        doc_.warn("flattened", "{}: is scaled to no volume and left out", node_label(doc_, placed.node));
        continue;
      }
      if (scene_.instances.size() >= doc_.limits.max_instances)
        throw doc_.error("{}: more than {} instances", node_label(doc_, placed.node),
                         doc_.limits.max_instances);
      scene_.instances.push_back(
          {.name = node.name,
           .mesh = drawn.mesh,
           .world_from_object = drawn.in_world ? glm::dmat4(1) : placed.world_from_node});
    }
  }

 private:
  struct Drawn {
    int mesh;       // of the scene
    bool in_world;  // skinned: its vertices are in world space
  };

  const std::vector<Drawn>& meshes_of(int mesh, int skin, const std::vector<double>& weights) {
    const auto [known, is_new] = drawn_.try_emplace({mesh, skin, weights});
    if (is_new) known->second = read(mesh, skin, weights);
    return known->second;
  }

  std::vector<Drawn> read(int mesh, int skin, const std::vector<double>& weights) {
    const tinygltf::Mesh& in = doc_.model.meshes[mesh];
    std::vector<Drawn> out;
    for (size_t i = 0; i < in.primitives.size(); ++i) {
      const std::string place = fmt::format("{} primitive {}", label("mesh", mesh, in.name), i);
      auto primitive = read_primitive(doc_, in.primitives[i], scene_.materials, budget_, place);
      if (!primitive) continue;
      apply_morph_targets(doc_, in.primitives[i], weights, place, primitive->mesh);
      const bool skinned = skin >= 0 && primitive->skin.sets > 0;
      if (skinned) {
        doc_.warn("skin", "skins are drawn in their rest pose");
        apply_skin(doc_, joints_of(skin), primitive->skin, place, primitive->mesh);
      }
      complete_mesh(doc_, scene_.materials, budget_, place, primitive->mesh);
      primitive->mesh.name = in.name;
      out.push_back({static_cast<int>(scene_.meshes.size()), skinned});
      scene_.meshes.push_back(std::move(primitive->mesh));
    }
    return out;
  }

  const std::vector<glm::dmat4>& joints_of(int skin) {
    const auto [known, is_new] = joints_.try_emplace(skin);
    if (is_new) known->second = joint_matrices(doc_, skin, nodes_);
    return known->second;
  }

  Document& doc_;
  const std::vector<PlacedNode>& nodes_;
  Scene& scene_;
  Budget budget_;
  // By the file's mesh, skin and weights of morph targets.
  std::map<std::tuple<int, int, std::vector<double>>, std::vector<Drawn>> drawn_;
  std::map<int, std::vector<glm::dmat4>> joints_;
};

}  // namespace

void add_meshes(Document& doc, const std::vector<PlacedNode>& nodes, Scene& scene) {
  MeshReader reader(doc, nodes, scene);
  for (const PlacedNode& placed : nodes) reader.add(placed);
}

}  // namespace lightgrid::gltf
