#include "scene/gltf/primitive.h"

#include <algorithm>
#include <cmath>

namespace lightgrid::gltf {

void spend(const Document& doc, size_t& left, size_t amount, const std::string& place, const char* what) {
  if (amount > left)
    throw doc.error("{}: {} {} more pass the limit of {} vertices", place, amount, what,
                    doc.limits.max_vertices);
  left -= amount;
}

namespace {

// Attributes of one primitive, from accessors or from Draco's data.
class Attributes {
 public:
  Attributes(Document& doc, const tinygltf::Primitive& primitive, const DracoGeometry* draco,
             size_t vertex_count, std::string place)
      : doc_(doc),
        primitive_(primitive),
        draco_(draco),
        vertex_count_(vertex_count),
        place_(std::move(place)) {}

  bool has(const std::string& name) const {
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end()) return false;
    return (draco_ && draco_->attributes.contains(name)) ||
           !is_empty_accessor(doc_, found->second, place_ + ": " + name);
  }

  // Empty if the primitive has none.
  template <int N>
  std::vector<glm::vec<N, float>> read(const std::string& name, int min_components,
                                       Normalize normalize) const {
    if (!has(name)) return {};
    const std::string place = place_ + ": " + name;
    const FloatArray array =
        draco_ && draco_->attributes.contains(name)
            ? draco_->attributes.at(name)
            : read_floats(doc_, primitive_.attributes.at(name), vertex_count_, normalize, place);
    if (array.count() != vertex_count_)
      throw doc_.error("{}: has {} elements, but there are {} vertices", place, array.count(), vertex_count_);
    return to_vectors<N>(doc_, array, min_components, 1.0f, place);
  }

 private:
  Document& doc_;
  const tinygltf::Primitive& primitive_;
  const DracoGeometry* draco_;
  size_t vertex_count_;
  std::string place_;
};

// glTF 2.0, 3.7.2.1: every triangle keeps the orientation of the strip's or fan's first.
std::vector<uint32_t> triangle_list(const std::vector<uint32_t>& in, int mode) {
  std::vector<uint32_t> out;
  if (in.size() < 3) return out;
  out.reserve((in.size() - 2) * 3);
  for (size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    else
      out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
  }
  return out;
}

std::vector<uint32_t> read_triangles(Document& doc, const tinygltf::Primitive& primitive, size_t vertex_count,
                                     Budget& budget, const std::string& place) {
  std::vector<uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(doc, primitive.indices, budget.indices, place + ": indices");
  } else {
    indices.resize(vertex_count);
    for (size_t i = 0; i < vertex_count; ++i) indices[i] = static_cast<uint32_t>(i);
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
    if (indices.size() % 3 != 0)
      doc.warn("triangle count", "{}: {} indices are not whole triangles; the rest is left out", place,
               indices.size());
    indices.resize(indices.size() / 3 * 3);
    return indices;
  }
  spend(doc, budget.indices, indices.size() * 2, place, "indices");
  return triangle_list(indices, primitive.mode);
}

SkinWeights read_skin_weights(const Document& doc, const Attributes& attributes, size_t vertex_count,
                              const std::string& place) {
  SkinWeights out;
  while (attributes.has(fmt::format("JOINTS_{}", out.sets)) &&
         attributes.has(fmt::format("WEIGHTS_{}", out.sets)))
    ++out.sets;
  if (out.sets > 4) throw doc.error("{}: has {} sets of joints; at most 4 are read", place, out.sets);
  out.joints.resize(vertex_count * out.sets);
  out.weights.resize(vertex_count * out.sets);
  for (int set = 0; set < out.sets; ++set) {
    const auto joints = attributes.read<4>(fmt::format("JOINTS_{}", set), 4, Normalize::as_accessor_says);
    const auto weights = attributes.read<4>(fmt::format("WEIGHTS_{}", set), 4, Normalize::always);
    for (size_t i = 0; i < vertex_count; ++i) {
      out.joints[i * out.sets + set] = glm::uvec4(glm::max(joints[i], 0.0f));
      out.weights[i * out.sets + set] = weights[i];
    }
  }
  return out;
}

std::pair<std::string, std::string> uv_attributes(const Document& doc, const tinygltf::Primitive& primitive) {
  const auto found = doc.uv_sets.find(primitive.material);
  const auto [first, second] = found == doc.uv_sets.end() ? std::array{0, 1} : found->second;
  return {fmt::format("TEXCOORD_{}", first), fmt::format("TEXCOORD_{}", second)};
}

bool is_drawn(Document& doc, const tinygltf::Primitive& primitive, const std::string& place) {
  if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    throw doc.error("{}: mode is {}", place, primitive.mode);
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    doc.warn("points and lines", "{}: points and lines are left out", place);
    return false;
  }
  if (!primitive.attributes.contains("POSITION")) {
    doc.warn("no positions", "{}: has no POSITION and is left out", place);
    return false;
  }
  if (primitive.extensions.contains("KHR_draco_mesh_compression")) return true;
  return !is_empty_accessor(doc, primitive.attributes.at("POSITION"), place + ": POSITION") &&
         (primitive.indices < 0 || !is_empty_accessor(doc, primitive.indices, place + ": indices"));
}

}  // namespace

std::optional<Primitive> read_primitive(Document& doc, const tinygltf::Primitive& primitive,
                                        const std::vector<Material>& materials, Budget& budget,
                                        const std::string& place) {
  if (!is_drawn(doc, primitive, place)) return {};

  std::optional<DracoGeometry> draco;
  if (const auto* extension = find_extension(primitive.extensions, "KHR_draco_mesh_compression"))
    draco = decode_draco(doc, primitive, *extension, budget.vertices, place);
  const size_t vertex_count =
      draco ? draco->vertex_count
            : checked(doc, doc.model.accessors, primitive.attributes.at("POSITION"), place, "POSITION").count;
  spend(doc, budget.vertices, vertex_count, place, "vertices");

  const Attributes attributes(doc, primitive, draco ? &*draco : nullptr, vertex_count, place);
  Primitive out;
  out.mesh.positions = attributes.read<3>("POSITION", 3, Normalize::as_accessor_says);
  out.mesh.normals = attributes.read<3>("NORMAL", 3, Normalize::always);
  out.mesh.tangents = attributes.read<4>("TANGENT", 4, Normalize::always);
  const auto [uv0, uv1] = uv_attributes(doc, primitive);
  out.mesh.uv0 = attributes.read<2>(uv0, 2, Normalize::as_accessor_says);
  out.mesh.uv1 = attributes.read<2>(uv1, 2, Normalize::as_accessor_says);
  out.mesh.colors = attributes.read<4>("COLOR_0", 3, Normalize::always);
  for (glm::vec4& color : out.mesh.colors)
    color = glm::clamp(color, 0.0f, 1.0f);  // as the specification requires
  out.skin = read_skin_weights(doc, attributes, vertex_count, place);

  out.mesh.indices =
      draco ? std::move(draco->indices) : read_triangles(doc, primitive, vertex_count, budget, place);
  spend(doc, budget.indices, out.mesh.indices.size(), place, "indices");
  for (uint32_t index : out.mesh.indices)
    if (index >= vertex_count)
      throw doc.error("{}: indices: {} is past the last of {} vertices", place, index, vertex_count);
  if (out.mesh.indices.empty()) return {};

  const int default_material = static_cast<int>(materials.size()) - 1;
  out.mesh.material = primitive.material < 0 ? default_material : primitive.material;
  if (out.mesh.material > default_material || primitive.material == default_material)
    throw doc.error("{}: material is {}, but there are {}", place, primitive.material, default_material);
  return out;
}

void spend_on_flat_normals(const Document& doc, const Mesh& mesh, Budget& budget, const std::string& place) {
  if (mesh.normals.empty() && mesh.indices.size() > mesh.positions.size())
    spend(doc, budget.vertices, mesh.indices.size() - mesh.positions.size(), place, "vertices");
}

namespace {

// One target of a primitive.
class TargetReader {
 public:
  TargetReader(Document& doc, const std::map<std::string, int>& accessors, Budget& budget, std::string place)
      : doc_(doc), accessors_(accessors), budget_(budget), place_(std::move(place)) {}

  // Empty if the target does not displace the attribute, or if the mesh (with `values`) does not have it.
  template <int N, typename Value>
  std::vector<glm::vec<N, float>> read(const std::string& attribute, int min_components, Normalize normalize,
                                       const std::vector<Value>& values) const {
    const auto accessor = accessors_.find(attribute);
    if (values.empty() || accessor == accessors_.end()) return {};
    const std::string place = fmt::format("{} {}", place_, attribute);
    if (is_empty_accessor(doc_, accessor->second, place)) return {};
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
  const auto [uv0, uv1] = uv_attributes(doc, primitive);
  for (size_t i = 0; i < out.size(); ++i) {
    if (!animated && weights[i] == 0) continue;
    const TargetReader target(doc, primitive.targets[i], budget, fmt::format("{}: target {}", place, i));
    out[i].positions = target.read<3>("POSITION", 3, Normalize::as_accessor_says, mesh.positions);
    out[i].normals = target.read<3>("NORMAL", 3, Normalize::always, mesh.normals);
    out[i].tangents = target.read<3>("TANGENT", 3, Normalize::always, mesh.tangents);
    out[i].uv0 = target.read<2>(uv0, 2, Normalize::as_accessor_says, mesh.uv0);
    out[i].uv1 = target.read<2>(uv1, 2, Normalize::as_accessor_says, mesh.uv1);
    out[i].colors = target.read<4>("COLOR_0", 3, Normalize::always, mesh.colors);
  }
  return out;
}

}  // namespace lightgrid::gltf
