#include "scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/text.h"
#include "scene/gltf/accessor.h"

namespace lightgrid::gltf {
namespace {

// Number of morph targets of a mesh: the same for all of its primitives that have any.
size_t target_count(const Document& doc, int node) {
  const int mesh = doc.model.nodes[node].mesh;
  if (mesh < 0) return 0;
  size_t count = 0;
  for (const tinygltf::Primitive& primitive : doc.model.meshes[mesh].primitives)
    count = std::max(count, primitive.targets.size());
  return count;
}

// The target of a channel. Without a path: nothing that is read.
struct Target {
  int index = -1;  // node or light of the file
  std::optional<AnimatedPath> path;
};

std::optional<AnimatedPath> read_path(const std::string& path) {
  if (path == "translation") return AnimatedPath::translation;
  if (path == "rotation") return AnimatedPath::rotation;
  if (path == "scale") return AnimatedPath::scale;
  if (path == "weights") return AnimatedPath::weights;
  return {};
}

std::optional<AnimatedPath> path_of_light(std::string_view property) {
  if (property == "color") return AnimatedPath::color;
  if (property == "intensity") return AnimatedPath::intensity;
  if (property == "range") return AnimatedPath::range;
  if (property == "spot/innerConeAngle") return AnimatedPath::inner_cone;
  if (property == "spot/outerConeAngle") return AnimatedPath::outer_cone;
  return {};
}

// KHR_animation_pointer (Khronos, 2024), for nodes and lights.
Target target_of_pointer(std::string_view pointer) {
  constexpr std::string_view nodes = "/nodes/", lights = "/extensions/KHR_lights_punctual/lights/";
  const bool of_light = pointer.starts_with(lights);
  if (!of_light && !pointer.starts_with(nodes)) return {};
  pointer.remove_prefix(of_light ? lights.size() : nodes.size());
  const size_t slash = pointer.find('/');
  if (slash == std::string_view::npos) return {};
  const auto index = parse_number<int>(pointer.substr(0, slash));
  if (!index || *index < 0) return {};
  const std::string_view property = pointer.substr(slash + 1);
  if (of_light) return {*index, path_of_light(property)};
  if (property == "extensions/KHR_node_visibility/visible") return {*index, AnimatedPath::visible};
  return {*index, read_path(std::string(property))};
}

// The pointer without its numbers: one warning names the same property of all materials.
std::string kind_of(std::string pointer) {
  std::erase_if(pointer, [](char c) { return c >= '0' && c <= '9'; });
  return "animation " + pointer;
}

int components_of(AnimatedPath path) {
  if (path == AnimatedPath::rotation) return 4;
  const bool is_vector =
      path == AnimatedPath::translation || path == AnimatedPath::scale || path == AnimatedPath::color;
  return is_vector ? 3 : 1;
}

Interpolation read_interpolation(const Document& doc, const std::string& name, const std::string& place) {
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  throw doc.error("{}: interpolation is \"{}\"", place, name);
}

class AnimationReader {
 public:
  AnimationReader(Document& doc, const std::vector<PlacedNode>& nodes)
      : doc_(doc),
        nodes_(nodes),
        values_left_(doc.limits.max_animation_values),
        place_of_node_(doc.model.nodes.size(), -1) {
    for (size_t i = 0; i < nodes.size(); ++i) place_of_node_[nodes[i].node] = static_cast<int>(i);
  }

  // After an error the reader is unchanged, except by warnings.
  Animation read(const AnimationEntry& entry, const std::string& place) {
    if (entry.fault) throw *entry.fault;
    const size_t values_before = values_left_;
    try {
      return read_channels(entry, place);
    } catch (const Error&) {
      values_left_ = values_before;
      throw;
    }
  }

 private:
  Animation read_channels(const AnimationEntry& entry, const std::string& place) {
    Animation out{.name = entry.name, .channels = {}};
    std::set<std::pair<int, AnimatedPath>> targets;
    for (size_t i = 0; i < entry.channels.size(); ++i) {
      const std::string inner = fmt::format("{} channel {}", place, i);
      auto channel = read_target(entry.channels[i], inner);
      if (!channel) continue;
      if (!targets.insert({channel->node, channel->path}).second)
        throw doc_.error("{}: an earlier channel animates the {} too", inner, name_of(entry.channels[i]));
      if (entry.channels[i].sampler < 0) throw doc_.error("{}: has no sampler", inner);
      if (!read_keys(checked(doc_, entry.samplers, entry.channels[i].sampler, inner, "sampler"),
                     fmt::format("{} sampler {}", place, entry.channels[i].sampler), *channel))
        continue;
      out.channels.push_back(*std::move(channel));
    }
    return out;
  }

  // Empty if the channel moves nothing in this scene.
  std::optional<AnimationChannel> read_target(const AnimationEntry::Channel& in, const std::string& place) {
    const bool is_pointer = in.path == "pointer";
    const Target target = is_pointer ? target_of_pointer(in.pointer) : Target{in.node, read_path(in.path)};
    if (!target.path && is_pointer)
      doc_.warn(kind_of(in.pointer), "{}: pointer \"{}\" is not supported; left out", place, in.pointer);
    else if (!target.path && in.node >= 0)
      doc_.warn("animation path", "{}: path \"{}\" is not supported; left out", place, in.path);
    if (!target.path || target.index < 0) return {};
    AnimationChannel out{.node = target.index,
                         .path = *target.path,
                         .components = components_of(*target.path),
                         .times = {},
                         .values = {}};
    if (is_of_light(out.path)) {
      checked(doc_, doc_.model.lights, target.index, place, "target light");
      return out;
    }
    out.node = checked(doc_, place_of_node_, target.index, place, "target node");
    if (out.node < 0) return {};
    if (out.path == AnimatedPath::visible) return out;
    if (out.path == AnimatedPath::weights) {
      out.components = static_cast<int>(target_count(doc_, target.index));
      if (out.components > 0) return out;
      doc_.warn("animated weights", "{}: {} has no morph targets; left out", place,
                node_label(doc_, target.index));
      return {};
    }
    if (nodes_[out.node].matrix)
      throw doc_.error("{}: {} has a matrix; only translation, rotation and scale can be animated", place,
                       node_label(doc_, target.index));
    return out;
  }

  // False if the sampler has no keys.
  bool read_keys(const AnimationEntry::Sampler& in, const std::string& place, AnimationChannel& out) {
    if (in.input < 0 || in.output < 0)
      throw doc_.error("{}: has no {}", place, in.input < 0 ? "input" : "output");
    if (is_empty_accessor(doc_, in.input, place + ": input") ||
        is_empty_accessor(doc_, in.output, place + ": output"))
      return false;
    out.interpolation = read_interpolation(doc_, in.interpolation, place);
    out.times = read_values(in.input, Normalize::as_accessor_says, "SCALAR", true, place + ": input");
    check_times(out.times, place);
    const bool is_cubic = out.interpolation == Interpolation::cubic_spline;
    if (is_cubic && out.path == AnimatedPath::visible)
      throw doc_.error("{}: interpolation is CUBICSPLINE, but visible is true or false: STEP", place);
    if (out.path == AnimatedPath::visible) out.interpolation = Interpolation::step;
    if (is_cubic && out.times.size() < 2)
      throw doc_.error("{}: a cubic spline of one key; it needs two", place);
    const int components = components_of(out.path);
    const char* type = components == 1 ? "SCALAR" : components == 4 ? "VEC4" : "VEC3";
    const bool is_float = out.path == AnimatedPath::translation || out.path == AnimatedPath::scale;
    out.values = read_values(in.output, Normalize::always, type, is_float, place + ": output");
    const size_t a_key = static_cast<size_t>(out.components) * (is_cubic ? 3 : 1);
    if (out.values.size() != out.times.size() * a_key)
      throw doc_.error("{}: output has {} numbers for {} keys of {}", place, out.values.size(),
                       out.times.size(), a_key);
    if (out.path == AnimatedPath::rotation) check_rotations(out, is_cubic, place);
    return true;
  }

  std::vector<float> read_values(int accessor, Normalize normalize, const char* type, bool only_float,
                                 const std::string& place) {
    const tinygltf::Accessor& in = checked(doc_, doc_.model.accessors, accessor, place, "accessor");
    const int wanted = type == std::string_view("SCALAR") ? 1 : type[3] - '0';
    if (in.type != (wanted == 1 ? TINYGLTF_TYPE_SCALAR : wanted))
      throw doc_.error("{}: is not of type {}", place, type);
    if (only_float && in.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      throw doc_.error("{}: componentType is {}; it must be float", place, in.componentType);
    if (in.count > values_left_ / wanted)
      throw doc_.error("{}: with it, animations have more than {} numbers", place,
                       doc_.limits.max_animation_values);
    values_left_ -= in.count * wanted;
    return read_floats(doc_, accessor, in.count, normalize, place).values;
  }

  // Equal times are accepted, although the specification requires them to increase: exporters use them for
  // jumps.
  void check_times(const std::vector<float>& times, const std::string& place) const {
    if (times[0] < 0) throw doc_.error("{}: input: time 0 is {}, before 0", place, times[0]);
    for (size_t i = 1; i < times.size(); ++i)
      if (times[i] < times[i - 1])
        throw doc_.error("{}: input: time {} is {}, before {}", place, i, times[i], times[i - 1]);
  }

  static std::string name_of(const AnimationEntry::Channel& channel) {
    return channel.path == "pointer" ? channel.pointer
                                     : fmt::format("{} of node {}", channel.path, channel.node);
  }

  void check_rotations(const AnimationChannel& channel, bool is_cubic, const std::string& place) const {
    for (size_t key = 0; key < channel.times.size(); ++key) {
      const float* q = channel.values.data() + (is_cubic ? key * 3 + 1 : key) * 4;
      const double length =
          std::hypot(std::hypot(double(q[0]), double(q[1])), std::hypot(double(q[2]), double(q[3])));
      if (!(length > 1e-12))
        throw doc_.error("{}: output: rotation {} is a quaternion of length {}", place, key, length);
    }
  }

  Document& doc_;
  const std::vector<PlacedNode>& nodes_;
  size_t values_left_;
  std::vector<int> place_of_node_;  // by the file's index; -1: not in the scene
};

}  // namespace

std::vector<Animation> read_animations(Document& doc, std::vector<PlacedNode>& nodes) {
  AnimationReader reader(doc, nodes);
  std::vector<Animation> out;
  std::vector<Error> faults;
  for (const AnimationEntry& entry : doc.animations) {
    const std::string place = label("animation", static_cast<int>(out.size()), entry.name);
    Animation& animation = out.emplace_back(Animation{.name = entry.name, .channels = {}});
    try {
      animation = reader.read(entry, place);
    } catch (const Error& fault) {
      faults.push_back(fault);
    }
  }
  Document::warn_left_out(faults, "animation");
  for (const Animation& animation : out)
    for (const AnimationChannel& channel : animation.channels) {
      if (is_of_light(channel.path)) continue;
      PlacedNode& node = nodes[channel.node];
      node.blinks |= channel.path == AnimatedPath::visible;
      (channel.path == AnimatedPath::weights ? node.morphs : node.moves) = true;
      node.scales |= channel.path == AnimatedPath::scale;
    }
  for (PlacedNode& node : nodes) {
    node.off = !node.visible && !node.blinks;
    if (node.parent < 0) continue;
    node.off |= nodes[node.parent].off;
    node.blinks |= nodes[node.parent].blinks;
    node.moves |= nodes[node.parent].moves;
    node.scales |= nodes[node.parent].scales;
  }
  return out;
}

}  // namespace lightgrid::gltf
