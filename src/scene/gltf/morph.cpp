#include "scene/gltf/morph.h"

#include <algorithm>
#include <cmath>

namespace lightgrid::gltf {
namespace {

// One target of a primitive.
class TargetReader {
 public:
  TargetReader(Document& doc, const std::map<std::string, int>& accessors, Budget& budget, std::string place)
      : doc_(doc), accessors_(accessors), budget_(budget), place_(std::move(place)) {}

  // Empty if the target does not displace the attribute, or if the mesh (with `values`) does not have it.
  template <int N, typename Value>
  std::vector<glm::vec<N, float>> read(const char* attribute, int min_components, Normalize normalize,
                                       const std::vector<Value>& values) const {
    const auto accessor = accessors_.find(attribute);
    if (values.empty() || accessor == accessors_.end()) return {};
    const std::string place = fmt::format("{} {}", place_, attribute);
    spend(doc_, budget_.vertices, values.size(), place, "displaced vertices");
    const FloatArray array = read_floats(doc_, accessor->second, values.size(), normalize, place);
    if (array.count() != values.size())
      throw doc_.error("{}: has {} elements, but there are {} vertices", place, array.count(), values.size());
    return to_vectors<N>(doc_, array, min_components, 0, place);
  }

 private:
  Document& doc_;
  const std::map<std::string, int>& accessors_;
  Budget& budget_;
  std::string place_;
};

}  // namespace

std::vector<double> default_weights(const Document& doc, const tinygltf::Node& node,
                                    const tinygltf::Mesh& mesh, const std::string& place) {
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  for (size_t i = 0; i < weights.size(); ++i)
    if (!std::isfinite(weights[i])) throw doc.error("{}: weights[{}] is {}", place, i, weights[i]);
  const bool any = std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; });
  return any ? weights : std::vector<double>();
}

std::vector<MorphTarget> read_morph_targets(Document& doc, const tinygltf::Primitive& primitive,
                                            const std::vector<double>& weights, bool animated,
                                            const Mesh& mesh, Budget& budget, const std::string& place) {
  if (primitive.targets.empty() || (weights.empty() && !animated)) return {};
  if (!weights.empty() && weights.size() != primitive.targets.size())
    throw doc.error("{}: there are {} weights for {} morph targets", place, weights.size(),
                    primitive.targets.size());
  std::vector<MorphTarget> out(primitive.targets.size());
  for (size_t i = 0; i < out.size(); ++i) {
    if (!animated && weights[i] == 0) continue;
    const TargetReader target(doc, primitive.targets[i], budget, fmt::format("{}: target {}", place, i));
    out[i].positions = target.read<3>("POSITION", 3, Normalize::as_accessor_says, mesh.positions);
    out[i].normals = target.read<3>("NORMAL", 3, Normalize::always, mesh.normals);
    out[i].tangents = target.read<3>("TANGENT", 3, Normalize::always, mesh.tangents);
    out[i].uv0 = target.read<2>("TEXCOORD_0", 2, Normalize::as_accessor_says, mesh.uv0);
    out[i].uv1 = target.read<2>("TEXCOORD_1", 2, Normalize::as_accessor_says, mesh.uv1);
    out[i].colors = target.read<4>("COLOR_0", 3, Normalize::always, mesh.colors);
  }
  return out;
}

}  // namespace lightgrid::gltf
