#include "scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/pose.h"

namespace lightgrid::gltf {
namespace {

float checked_amount(const Document& doc, double value, const std::string& place, const char* what) {
  const auto out = static_cast<float>(value);
  if (!(value >= 0) || !std::isfinite(out)) throw doc.error("{}: {} is {}", place, what, value);
  return out;
}

// Angles that the extension does not allow are replaced by the nearest ones that it does. Exporters that keep
// floats write 90 degrees a little above pi/2. False: the cone has no width.
bool read_cone(Document& doc, const tinygltf::SpotLight& spot, const std::string& place, Light& light) {
  constexpr double rounding = 1e-6;
  const auto nearest = [&](const char* name, double angle, double most) {
    const double allowed = angle >= 0 ? std::min(angle, most) : 0;
    if (!(std::abs(angle - allowed) <= rounding))
      doc.warn(name, "{}: spot.{} is {}, outside 0 to {}; it counts as {}", place, name, angle, most,
               allowed);
    return allowed;
  };
  const double outer = nearest("outerConeAngle", spot.outerConeAngle, glm::half_pi<double>());
  if (static_cast<float>(outer) == 0) {
    doc.warn("no cone", "{}: spot.outerConeAngle is 0; it lights nothing", place);
    return false;
  }
  const double inner = nearest("innerConeAngle", spot.innerConeAngle, outer);
  light.outer_cone_rad = static_cast<float>(outer), light.inner_cone_rad = static_cast<float>(inner);
  // Two doubles may round to one float, which would be a hard edge.
  if (inner < outer)
    light.inner_cone_rad = std::min(light.inner_cone_rad, std::nextafter(light.outer_cone_rad, 0.0f));
  return true;
}

// The part that does not depend on the node.
Light read_light(Document& doc, const tinygltf::Light& in, bool has_range, const std::string& place) {
  Light out;
  bool shines = true;
  if (in.type == "point") {
    out.type = LightType::point;
  } else if (in.type == "spot") {
    out.type = LightType::spot;
    shines = read_cone(doc, in.spot, place, out);
  } else if (in.type == "directional") {
    out.type = LightType::directional;
  } else {
    throw doc.error("{}: type is \"{}\"", place, in.type);
  }
  if (!in.color.empty() && in.color.size() != 3)
    throw doc.error("{}: color has {} numbers instead of 3", place, in.color.size());
  for (size_t i = 0; i < in.color.size(); ++i)
    out.color[i] = checked_amount(doc, in.color[i], place, "color");
  out.intensity = checked_amount(doc, in.intensity, place, "intensity");
  if (!shines) out.intensity = 0;
  if (intensity_overflows(out))
    throw doc.error("{}: intensity {} times color passes the largest float, {:g}", place, in.intensity,
                    std::numeric_limits<float>::max());
  if (has_range && out.type != LightType::directional) {
    out.radius_m = checked_amount(doc, in.range, place, "range");
    if (out.radius_m == 0) throw doc.error("{}: range is {}; it must be more than 0", place, in.range);
  }
  return out;
}

// tinygltf makes an absent range 0; a range of 0 in the file is an error.
bool has_range(const Document& doc, int light) {
  const tinygltf::Value* extension = find_extension(doc.model.extensions, "KHR_lights_punctual");
  if (!extension || !extension->Get("lights").IsArray()) return false;
  const tinygltf::Value& value = extension->Get("lights").Get(light);
  return value.IsObject() && value.Has("range");
}

// A node's extras override its light's.
bool casts_shadow(const Document& doc, int node, int light) {
  if (const auto of_node = node_casts_shadow(doc, node)) return *of_node;
  const auto found = doc.shadows.of_light.find(light);
  if (found == doc.shadows.of_light.end()) return false;
  if (!found->second)
    throw doc.error("light {}: extras.casts_shadow is neither true, false nor a number", light);
  return *found->second;
}

// Below 0: neither has one.
float source_radius(const Document& doc, int node, int light) {
  const auto &of_node = doc.shadows.source_of_node, &of_light = doc.shadows.source_of_light;
  const auto read = [&](const auto& entries, int index, const std::string& place) {
    const auto found = entries.find(index);
    if (found == entries.end()) return -1.0f;
    if (!found->second) throw doc.error("{}: extras.source_radius is not a number", place);
    return checked_amount(doc, *found->second, place, "extras.source_radius");
  };
  const float own = read(of_node, node, node_label(doc, node));
  return own >= 0 ? own : read(of_light, light, label("light", light, ""));
}

}  // namespace

std::vector<Light> read_lights(Document& doc, const std::vector<PlacedNode>& nodes) {
  std::vector<Light> out;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const PlacedNode& placed = nodes[i];
    const tinygltf::Node& node = doc.model.nodes[placed.node];
    const tinygltf::Value* extension = find_extension(node.extensions, "KHR_lights_punctual");
    if (!extension) continue;
    const std::string place = node_label(doc, placed.node);
    if (!extension->Has("light")) throw doc.error("{}: KHR_lights_punctual has no light", place);
    const int index = static_cast<int>(size_or(doc, *extension, "light", 0, place));
    const tinygltf::Light& in = checked(doc, doc.model.lights, index, place, "KHR_lights_punctual.light");
    Light light = read_light(doc, in, has_range(doc, index), label("light", index, in.name));
    light.name = node.name.empty() ? in.name : node.name;
    light.position = glm::dvec3(placed.world_from_node[3]);
    light.casts_shadow = casts_shadow(doc, placed.node, index);
    light.source_m = source_radius(doc, placed.node, index);
    if (placed.moves) light.node = static_cast<int>(i);
    if (const auto direction = light_direction(placed.world_from_node))
      light.direction = *direction;
    else if (light.type != LightType::point)
      throw doc.error("{}: light {} has no direction: its node is scaled to {}", place, index,
                      glm::length(glm::dvec3(placed.world_from_node[2])));
    out.push_back(std::move(light));
  }
  return out;
}

std::vector<GroupLists> groups_of_lights(Document& doc, const std::vector<PlacedNode>& nodes) {
  std::vector<GroupLists> out;
  int light = -1;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Value* extension =
        find_extension(doc.model.nodes[placed.node].extensions, "KHR_lights_punctual");
    if (!extension) continue;
    ++light;
    const std::string place = node_label(doc, placed.node);
    const auto index = static_cast<int>(size_or(doc, *extension, "light", 0, place));
    for (const auto& [entries, number] :
         {std::pair(&doc.groups.of_node, placed.node), std::pair(&doc.groups.of_light, index)}) {
      const auto found = entries->find(number);
      if (found == entries->end()) continue;
      out.push_back(found->second);
      out.back().owner = light, out.back().where = doc.place(place);
      break;
    }
  }
  return out;
}

std::vector<GroupLists> groups_of_instances(const Document& doc, const std::vector<int>& node_of_instance) {
  std::vector<GroupLists> out;
  for (size_t i = 0; i < node_of_instance.size(); ++i) {
    const auto found = doc.groups.of_node.find(node_of_instance[i]);
    if (found == doc.groups.of_node.end() || !found->second.groups) continue;
    out.push_back({.owner = static_cast<int>(i),
                   .where = doc.place(node_label(doc, node_of_instance[i])),
                   .groups = found->second.groups,
                   .include = {},
                   .exclude = {}});
  }
  return out;
}

namespace {

void read_perspective(const Document& doc, const tinygltf::PerspectiveCamera& in, const std::string& place,
                      Camera& out) {
  if (!(in.yfov > 0 && in.yfov < glm::pi<double>())) throw doc.error("{}: yfov is {}", place, in.yfov);
  if (!(in.znear > 0)) throw doc.error("{}: znear is {}", place, in.znear);
  if (!(in.aspectRatio >= 0)) throw doc.error("{}: aspectRatio is {}", place, in.aspectRatio);
  if (in.zfar != 0 && !(in.zfar > in.znear))
    throw doc.error("{}: zfar is {}, not beyond znear {}", place, in.zfar, in.znear);
  out.fov_y_rad = in.yfov, out.aspect = in.aspectRatio, out.near_m = in.znear;
  if (in.zfar != 0) out.far_m = in.zfar;
}

void read_orthographic(const Document& doc, const tinygltf::OrthographicCamera& in, const std::string& place,
                       Camera& out) {
  if (in.xmag == 0 || in.ymag == 0) throw doc.error("{}: xmag is {}, ymag is {}", place, in.xmag, in.ymag);
  if (!(in.znear >= 0 && in.zfar > in.znear))
    throw doc.error("{}: znear is {}, zfar is {}", place, in.znear, in.zfar);
  out.orthographic = true;
  out.half_width_m = std::abs(in.xmag), out.half_height_m = std::abs(in.ymag);
  out.near_m = in.znear, out.far_m = in.zfar;
}

Camera read_camera(const Document& doc, const PlacedNode& placed) {
  const tinygltf::Node& node = doc.model.nodes[placed.node];
  const std::string place = node_label(doc, placed.node);
  const tinygltf::Camera& in = checked(doc, doc.model.cameras, node.camera, place, "camera");
  const std::string camera_place = label("camera", node.camera, in.name);
  Camera camera{.name = node.name.empty() ? in.name : node.name};
  if (in.type == "orthographic")
    read_orthographic(doc, in.orthographic, camera_place, camera);
  else
    read_perspective(doc, in.perspective, camera_place, camera);
  const auto rigid = rigid_part(placed.world_from_node);
  if (!rigid) throw doc.error("{}: its camera's axes are scaled to 0", place);
  camera.world_from_view = *rigid;
  return camera;
}

}  // namespace

std::vector<Camera> read_cameras(Document& doc, const std::vector<PlacedNode>& nodes) {
  std::vector<Camera> out;
  std::vector<Error> faults;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (doc.model.nodes[nodes[i].node].camera < 0) continue;
    try {
      out.push_back(read_camera(doc, nodes[i]));
      if (nodes[i].moves) out.back().node = static_cast<int>(i);
    } catch (const Error& fault) {
      faults.push_back(fault);
    }
  }
  Document::warn_left_out(faults, "camera");
  return out;
}

}  // namespace lightgrid::gltf
