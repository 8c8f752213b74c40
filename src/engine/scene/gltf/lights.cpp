#include "scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <set>

#include "base/text.h"
#include "scene/area_lights.h"
#include "scene/gltf/accessor.h"
#include "scene/light_axes.h"
#include "scene/pose.h"

namespace lightgrid::gltf {
namespace {

// A negative value counts as 0, with a warning.
float read_amount(Document& doc, double value, const std::string& place, const char* what) {
  const auto out = static_cast<float>(value);
  if (!std::isfinite(out)) throw doc.error("{}: {} is {}", place, what, value);
  if (out < 0) doc.warn("negative light", "{}: {} is {}; it counts as 0", place, what, value);
  return std::max(out, 0.0f);
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
  light.outer_cone_rad = static_cast<float>(outer);
  light.inner_cone_rad = static_cast<float>(inner);
  // Two doubles may round to one float, which would be a hard edge.
  if (inner < outer)
    light.inner_cone_rad = std::min(light.inner_cone_rad, std::nextafter(light.outer_cone_rad, 0.0f));
  return true;
}

// The part that does not depend on the node; empty, with a warning, for an unknown type.
std::optional<Light> read_light(Document& doc, const tinygltf::Light& in, bool has_range,
                                const std::string& place) {
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
    doc.warn("light type", "{}: type is \"{}\", not point, spot or directional; left out", place, in.type);
    return {};
  }
  if (!in.color.empty() && in.color.size() != 3)
    throw doc.error("{}: color has {} numbers instead of 3", place, in.color.size());
  for (size_t i = 0; i < in.color.size(); ++i) out.color[i] = read_amount(doc, in.color[i], place, "color");
  out.intensity = read_amount(doc, in.intensity, place, "intensity");
  if (!shines) out.intensity = 0;
  if (intensity_overflows(out))
    throw doc.error("{}: intensity {} times color passes the largest float, {:g}", place, in.intensity,
                    std::numeric_limits<float>::max());
  if (has_range && out.type != LightType::directional) {
    const auto range = static_cast<float>(in.range);
    if (std::isnan(range)) throw doc.error("{}: range is {}", place, in.range);
    if (range > 0)
      out.radius_m = range;
    else  // exporters have written 0 for no range
      doc.warn("light range", "{}: range is {}; it counts as no range", place, in.range);
  }
  return out;
}

// tinygltf makes an absent range 0.
bool has_range(const Document& doc, int light) {
  const tinygltf::Value* extension = find_extension(doc.model.extensions, "KHR_lights_punctual");
  if (!extension || !extension->Get("lights").IsArray()) return false;
  const tinygltf::Value& value = extension->Get("lights").Get(light);
  return value.IsObject() && value.Has("range");
}

std::set<int> animated_lights(const Rig& rig) {
  std::set<int> lights;
  for (const Animation& animation : rig.animations)
    for (const AnimationChannel& channel : animation.channels)
      if (is_of_light(channel.path)) lights.insert(channel.node);
  return lights;
}

// The file of an extension's light: its URI, or the bytes of its buffer view as one.
std::string table_uri(Document& doc, const LightExtension& extension, int index) {
  const tinygltf::Value* root = find_extension(doc.model.extensions, extension.name);
  const std::string place = fmt::format("{} light {}", extension.name, index);
  const size_t count = root && root->Get("lights").IsArray() ? root->Get("lights").ArrayLen() : 0;
  if (size_t(index) >= count) throw doc.error("{} does not exist: the file has {}", place, count);
  const tinygltf::Value& light = root->Get("lights").Get(index);
  if (light.IsObject() && light.Get("uri").IsString()) return light.Get("uri").Get<std::string>();
  if (!light.IsObject() || !light.Has("bufferView"))
    throw doc.error("{}: has neither uri nor bufferView", place);
  const auto bytes = view_bytes(doc, int(size_or(doc, light, "bufferView", 0, place)), place);
  return "data:application/octet-stream;base64," + base64({bytes.begin(), bytes.end()});
}

void set_direction(const Document& doc, const PlacedNode& placed, int index, Light& light) {
  if (const auto direction = light_direction(placed.world_from_node))
    light.direction = *direction;
  else if (light.type != LightType::point)
    throw doc.error("{}: light {} has no direction: its node is scaled to {}", node_label(doc, placed.node),
                    index, glm::length(glm::dvec3(placed.world_from_node[2])));
}

// The light that an extension makes of a node, with the multiplier as its intensity.
Light light_of_extension(Document& doc, const LightExtension& extension, const tinygltf::Value& value,
                         const PlacedNode& placed, GivenProperties& given) {
  const tinygltf::Node& node = doc.model.nodes[placed.node];
  const std::string place = fmt::format("{}: {}", node_label(doc, placed.node), extension.name);
  if (!value.Has("light")) throw doc.error("{} has no light", place);
  Light light;
  light.name = node.name;
  light.position = glm::dvec3(placed.world_from_node[3]);
  light.intensity = read_amount(doc, number_or(doc, value, "multiplier", 1, place), place, "multiplier");
  if (value.Has("color")) {
    const tinygltf::Value& color = value.Get("color");
    if (!color.IsArray() || color.ArrayLen() != 3) throw doc.error("{}: color is not three numbers", place);
    for (int c = 0; c < 3; ++c) {
      if (!color.Get(c).IsNumber()) throw doc.error("{}: color is not three numbers", place);
      light.color[c] = std::min(read_amount(doc, color.Get(c).GetNumberAsDouble(), place, "color"), 1.0f);
    }
  }
  const std::string uri = table_uri(doc, extension, int(size_or(doc, value, "light", 0, place)));
  given.fields = extras_of(doc.extras.nodes, placed.node).properties;
  given.fields[extension.key] = uri;
  given.where = doc.place(place);
  given.extension = &extension;
  return light;
}

// EXT_lights_area: nits along -z of the node, and sizes that its largest scale multiplies. Empty, with a
// warning, for another shape than a rectangle.
std::optional<Light> read_area_light(Document& doc, const PlacedNode& placed) {
  const tinygltf::Value* extension =
      find_extension(doc.model.nodes[size_t(placed.node)].extensions, "EXT_lights_area");
  if (!extension) return {};
  const std::string place = node_label(doc, placed.node);
  const size_t index = size_or(doc, *extension, "light", 0, place);
  const tinygltf::Value* root = find_extension(doc.model.extensions, "EXT_lights_area");
  const tinygltf::Value lights = root && root->Has("lights") ? root->Get("lights") : tinygltf::Value();
  if (!lights.IsArray() || index >= lights.ArrayLen())
    throw doc.error("{}: EXT_lights_area.light is {}, but there are {}", place, index,
                    lights.IsArray() ? lights.ArrayLen() : 0);
  const tinygltf::Value& in = lights.Get(static_cast<int>(index));
  const std::string where = label("area light", static_cast<int>(index), "");
  const std::string type =
      in.Has("type") && in.Get("type").IsString() ? in.Get("type").Get<std::string>() : "";
  if (type != "rect") {
    doc.warn("area light type", "{}: type is \"{}\", not rect; left out", where, type);
    return {};
  }
  double scale = 0;
  for (int axis = 0; axis < 3; ++axis)
    scale = std::max(scale, glm::length(glm::dvec3(placed.world_from_node[axis])));
  const double height = scale * read_amount(doc, number_or(doc, in, "size", 1, where), where, "size");
  const tinygltf::Value rect = in.Has("rect") ? in.Get("rect") : tinygltf::Value();
  const double aspect = rect.IsObject() ? number_or(doc, rect, "aspect", 1, where) : 1;
  const double width = height * read_amount(doc, aspect, where, "aspect");
  Light light;
  light.name = doc.model.nodes[size_t(placed.node)].name;
  light.position = glm::dvec3(placed.world_from_node[3]);
  const tinygltf::Value color = in.Has("color") ? in.Get("color") : tinygltf::Value();
  for (int i = 0; color.IsArray() && color.ArrayLen() == 3 && i < 3; ++i)
    light.color[i] = read_amount(doc, color.Get(i).GetNumberAsDouble(), where, "color");
  light.intensity =
      read_amount(doc, number_or(doc, in, "intensity", 1000, where) * width * height, where, "intensity");
  if (intensity_overflows(light))
    throw doc.error("{}: intensity times color passes the largest float", where);
  set_rectangle(light, width, height);
  return light;
}

}  // namespace

void add_extension_lights(Document& doc, const std::vector<PlacedNode>& nodes, GivenByFile& given, Rig& rig,
                          std::vector<Light>& lights) {
  const auto add = [&](size_t i, const char* extension, Light light, GivenProperties properties) {
    const PlacedNode& placed = nodes[i];
    set_direction(doc, placed, -1, light);
    set_up(light, glm::dvec3(placed.world_from_node[1]));
    if (placed.moves) light.node = int(i);
    if (rig.lights.contains(light.node))
      throw doc.error("{}: {}: the node has two lights, of which an animation switches or changes one",
                      node_label(doc, placed.node), extension);
    if (placed.blinks) rig.lights[light.node] = {-1, light};
    properties.owner = int(lights.size());
    given.lights.push_back(std::move(properties));
    lights.push_back(std::move(light));
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    const PlacedNode& placed = nodes[i];
    if (placed.off) continue;
    for (const LightExtension& extension : light_extensions()) {
      const tinygltf::Value* value = find_extension(doc.model.nodes[placed.node].extensions, extension.name);
      if (!value) continue;
      GivenProperties properties;
      Light light = light_of_extension(doc, extension, *value, placed, properties);
      add(i, extension.name, std::move(light), std::move(properties));
    }
    if (std::optional<Light> area = read_area_light(doc, placed))
      add(i, "EXT_lights_area", std::move(*area),
          {.where = doc.place(node_label(doc, placed.node)),
           .fields = extras_of(doc.extras.nodes, placed.node).properties});
  }
}

std::vector<Light> read_lights(Document& doc, const std::vector<PlacedNode>& nodes, GivenByFile& given,
                               Rig& rig) {
  const std::set<int> animated = animated_lights(rig);
  std::vector<Light> out;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const PlacedNode& placed = nodes[i];
    const tinygltf::Node& node = doc.model.nodes[placed.node];
    const tinygltf::Value* extension = find_extension(node.extensions, "KHR_lights_punctual");
    if (!extension || placed.off) continue;
    const std::string place = node_label(doc, placed.node);
    if (!extension->Has("light")) throw doc.error("{}: KHR_lights_punctual has no light", place);
    const int index = static_cast<int>(size_or(doc, *extension, "light", 0, place));
    const tinygltf::Light& in = checked(doc, doc.model.lights, index, place, "KHR_lights_punctual.light");
    std::optional<Light> known = read_light(doc, in, has_range(doc, index), label("light", index, in.name));
    if (!known) continue;
    Light& light = *known;
    light.name = node.name.empty() ? in.name : node.name;
    light.position = glm::dvec3(placed.world_from_node[3]);
    const PlacedExtras &own = extras_of(doc.extras.nodes, placed.node),
                       &common = extras_of(doc.extras.lights, index);
    light.casts_shadow = own.casts_shadow.value_or(common.casts_shadow.value_or(light.casts_shadow));
    light.source_m = own.source_radius_m.value_or(common.source_radius_m.value_or(light.source_m));
    const bool switched = placed.blinks || animated.contains(index);
    if (placed.moves || switched) light.node = static_cast<int>(i);
    set_direction(doc, placed, index, light);
    if (GivenFields fields = own_or_common(own.properties, common.properties); !fields.empty()) {
      set_up(light, glm::dvec3(placed.world_from_node[1]));
      given.lights.push_back({static_cast<int>(out.size()), doc.place(place), std::move(fields)});
    }
    if (switched) rig.lights[light.node] = {index, light};
    out.push_back(std::move(light));
  }
  return out;
}

std::vector<GivenProperties> properties_of_instances(const Document& doc,
                                                     const std::vector<int>& node_of_instance) {
  std::vector<GivenProperties> out;
  for (size_t i = 0; i < node_of_instance.size(); ++i) {
    const int node = node_of_instance[i];
    GivenFields fields = fields_of_instances(extras_of(doc.extras.nodes, node).properties);
    if (!fields.empty())
      out.push_back({static_cast<int>(i), doc.place(node_label(doc, node)), std::move(fields)});
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
  out.fov_y_rad = in.yfov;
  out.aspect = in.aspectRatio;
  out.near_m = in.znear;
  if (in.zfar != 0) out.far_m = in.zfar;
}

void read_orthographic(const Document& doc, const tinygltf::OrthographicCamera& in, const std::string& place,
                       Camera& out) {
  if (in.xmag == 0 || in.ymag == 0) throw doc.error("{}: xmag is {}, ymag is {}", place, in.xmag, in.ymag);
  if (!(in.znear >= 0 && in.zfar > in.znear))
    throw doc.error("{}: znear is {}, zfar is {}", place, in.znear, in.zfar);
  out.orthographic = true;
  out.half_width_m = std::abs(in.xmag);
  out.half_height_m = std::abs(in.ymag);
  out.near_m = in.znear;
  out.far_m = in.zfar;
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
