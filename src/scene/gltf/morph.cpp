#include "scene/gltf/morph.h"

#include <algorithm>
#include <cmath>

#include "scene/gltf/accessor.h"

namespace lightgrid::gltf {
namespace {

// One attribute of a primitive with its targets.
class Morph {
 public:
  Morph(Document& doc, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
        const std::string& place)
      : doc_(doc), primitive_(primitive), weights_(weights), place_(place) {}

  // Calls set(value, sum of weighted displacements) for each value that some target displaces.
  template <int N, typename Value, typename Set>
  void apply(const char* attribute, int min_components, Normalize normalize, std::vector<Value>& values,
             const Set& set) {
    std::vector<glm::vec<N, double>> sums;
    for (size_t target = 0; target < weights_.size() && !values.empty(); ++target) {
      const auto accessor = primitive_.targets[target].find(attribute);
      if (weights_[target] == 0 || accessor == primitive_.targets[target].end()) continue;
      const std::string place = fmt::format("{}: target {} {}", place_, target, attribute);
      const FloatArray array = read_floats(doc_, accessor->second, values.size(), normalize, place);
      if (array.count() != values.size())
        throw doc_.error("{}: has {} elements, but there are {} vertices", place, array.count(),
                         values.size());
      const auto displacements = to_vectors<N>(doc_, array, min_components, 0, place);
      sums.resize(values.size(), glm::vec<N, double>(0));
      for (size_t i = 0; i < sums.size(); ++i)
        sums[i] += glm::vec<N, double>(displacements[i]) * weights_[target];
    }
    for (size_t i = 0; i < sums.size(); ++i) set(values[i], sums[i]);
  }

 private:
  Document& doc_;
  const tinygltf::Primitive& primitive_;
  const std::vector<double>& weights_;
  const std::string& place_;
};

glm::vec3 displaced_direction(const glm::vec3& direction, const glm::dvec3& by) {
  const glm::dvec3 sum = glm::dvec3(direction) + by;
  const double length = glm::length(sum);
  return length > 0 && std::isfinite(length) ? glm::vec3(sum / length) : direction;
}

}  // namespace

std::vector<double> default_weights(const Document& doc, const tinygltf::Node& node,
                                    const tinygltf::Mesh& mesh, const std::string& place) {
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  for (size_t i = 0; i < weights.size(); ++i)
    if (!std::isfinite(weights[i])) throw doc.error("{}: weights[{}] is {}", place, i, weights[i]);
  const bool any = std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; });
  return any ? weights : std::vector<double>();
}

void apply_morph_targets(Document& doc, const tinygltf::Primitive& primitive,
                         const std::vector<double>& weights, const std::string& place, Mesh& mesh) {
  if (weights.empty() || primitive.targets.empty()) return;
  if (weights.size() != primitive.targets.size())
    throw doc.error("{}: there are {} weights for {} morph targets", place, weights.size(),
                    primitive.targets.size());
  Morph morph(doc, primitive, weights, place);
  morph.apply<3>("POSITION", 3, Normalize::as_accessor_says, mesh.positions,
                 [&](glm::vec3& position, const glm::dvec3& by) {
                   position = glm::vec3(glm::dvec3(position) + by);
                   if (!std::isfinite(position.x + position.y + position.z))
                     throw doc.error("{}: its morph targets move a vertex to infinity", place);
                 });
  morph.apply<3>("NORMAL", 3, Normalize::always, mesh.normals,
                 [](glm::vec3& normal, const glm::dvec3& by) { normal = displaced_direction(normal, by); });
  morph.apply<3>("TANGENT", 3, Normalize::always, mesh.tangents,
                 [](glm::vec4& tangent, const glm::dvec3& by) {
                   tangent = glm::vec4(displaced_direction(glm::vec3(tangent), by), tangent.w);
                 });
  const auto add = [](glm::vec2& uv, const glm::dvec2& by) { uv = glm::vec2(glm::dvec2(uv) + by); };
  morph.apply<2>("TEXCOORD_0", 2, Normalize::as_accessor_says, mesh.uv0, add);
  morph.apply<2>("TEXCOORD_1", 2, Normalize::as_accessor_says, mesh.uv1, add);
  morph.apply<4>("COLOR_0", 3, Normalize::always, mesh.colors, [](glm::vec4& color, const glm::dvec4& by) {
    color = glm::clamp(glm::vec4(glm::dvec4(color) + by), 0.0f, 1.0f);
  });
}

}  // namespace lightgrid::gltf
