#include "scene/gltf/instancing.h"

#include <cmath>

#include "scene/gltf/accessor.h"
#include "scene/gltf/nodes.h"

namespace lightgrid::gltf {
namespace {

class InstanceReader {
 public:
  InstanceReader(Document& doc, const tinygltf::Value& attributes, std::string place)
      : doc_(doc), attributes_(attributes), place_(std::move(place)) {}

  std::vector<NodeTransform> read() {
    const size_t count = checked_count();
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
    if (count == 0) throw doc_.error("{}: {}: count is 0", place_, names.front());
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
