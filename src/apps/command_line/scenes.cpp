// lightgrid scenes: the built-in scenes and their contents. lightgrid info SCENE: the contents of one, or of
// a file.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "command_line/options.h"
#include "scene/animation.h"
#include "scene/hidden.h"
#include "scene/load_gltf.h"
#include "scenes/builtin.h"

namespace lightgrid::app {
namespace {

struct Contents {
  size_t instances = 0, triangles = 0, point = 0, spot = 0, directional = 0, without_range = 0;
  std::vector<std::string> cameras;
  size_t lights() const { return point + spot + directional; }
};

Contents contents_of(const Scene& scene) {
  Contents all;
  for (const Instance& i : scene.instances) {
    if (is_hidden(i)) continue;
    ++all.instances;
    all.triangles += scene.meshes[i.mesh].indices.size() / 3;
  }
  for (const Light& light : scene.lights) {
    if (is_hidden(light)) continue;
    all.point += light.type == LightType::point;
    all.spot += light.type == LightType::spot;
    all.directional += light.type == LightType::directional;
    all.without_range += !is_directional(light) && std::isinf(light.radius_m);
  }
  for (const Camera& camera : scene.cameras) all.cameras.push_back(camera.name);
  return all;
}

nlohmann::ordered_json lights_json(const Contents& all) {
  return {
      {"total", all.lights()}, {"point", all.point}, {"spot", all.spot}, {"directional", all.directional}};
}

int list_scenes(const std::string& json) {
  auto rows = nlohmann::ordered_json::array();
  if (json.empty())
    fmt::print("{:<8} {:>9} {:>6}  {}\n", "scene", "triangles", "lights", "contents and cameras");
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Contents all = contents_of(builtin.make());
    rows.push_back({{"name", builtin.name},
                    {"summary", builtin.summary},
                    {"triangles", all.triangles},
                    {"lights", lights_json(all)},
                    {"cameras", all.cameras}});
    if (!json.empty()) continue;
    fmt::print("{:<8} {:>9} {:>6}  {} ({})\n", builtin.name, all.triangles, all.lights(), builtin.summary,
               fmt::join(all.cameras, ", "));
  }
  if (!json.empty()) write_json(json, rows.dump(1));
  return 0;
}

struct InfoOptions : SceneChoice {
  std::string json;
};

nlohmann::ordered_json info_json(const Scene& scene, const InfoOptions& o,
                                 const std::vector<GltfExtension>& extensions) {
  const Contents all = contents_of(scene);
  const WorldBox box = world_box(scene);
  nlohmann::ordered_json lights = lights_json(all), used = nlohmann::ordered_json::array(), extent;
  lights["with_range"] = all.point + all.spot - all.without_range;
  lights["without_range"] = all.without_range;
  for (const GltfExtension& e : extensions)
    used.push_back({{"name", e.name}, {"drawn", e.supported}, {"required", e.required}});
  if (!box.empty())
    extent = {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
  return {{"scene", o.scene},
          {"extent", extent},
          {"triangles", all.triangles},
          {"instances", all.instances},
          {"meshes", scene.meshes.size()},
          {"materials", scene.materials.size()},
          {"textures", scene.textures.size()},
          {"cameras", all.cameras},
          {"lights", lights},
          {"animations", {{"count", animation_count(scene)}, {"seconds", duration_of(scene)}}},
          {"extensions", used}};
}

void print_info(const Scene& scene, const InfoOptions& o, const std::vector<GltfExtension>& extensions) {
  const auto line = [](const char* name, const std::string& text) { fmt::print("{:<12}{}\n", name, text); };
  const Contents all = contents_of(scene);
  const WorldBox box = world_box(scene);
  line("scene", o.scene);
  if (!box.empty()) {
    const glm::dvec3 size = box.max - box.min, a = box.min, b = box.max;
    line("extent",
         fmt::format("{:.4g} x {:.4g} x {:.4g} m, from {:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g}", size.x,
                     size.y, size.z, a.x, a.y, a.z, b.x, b.y, b.z));
  }
  line("triangles",
       fmt::format("{}, in {} instances of {} meshes; {} materials, {} textures", all.triangles,
                   all.instances, scene.meshes.size(), scene.materials.size(), scene.textures.size()));
  line("cameras", all.cameras.empty()
                      ? "none: the eye stands in the room if there is one, else it sees the whole"
                      : fmt::format("{}: \"{}\"", all.cameras.size(), fmt::join(all.cameras, "\", \"")));
  line("lights",
       all.lights() == 0
           ? "none: a key and a fill light are added (--lights N scatters others)"
           : fmt::format("{}: {} point, {} spot, {} directional; of point and spot lights {} have a range, "
                         "{} none",
                         all.lights(), all.point, all.spot, all.directional,
                         all.point + all.spot - all.without_range, all.without_range));
  const int animations = animation_count(scene);
  line("animations",
       animations ? fmt::format("{}, {:.4g} s: --time T shows one moment", animations, duration_of(scene))
                  : "none");
  for (const GltfExtension& e : extensions) {
    line(&e == &extensions.front() ? "extensions" : "",
         fmt::format("{}: {}{}", e.name, e.supported ? "drawn" : "not drawn, left out with a warning",
                     e.required ? ", required" : ""));
  }
  if (extensions.empty()) line("extensions", "none");
}

int info(const InfoOptions& o) {
  if (!o.json.empty()) check_output_file("--json", o.json);
  std::vector<GltfExtension> extensions;
  std::error_code unreadable;
  const bool is_file = !find_builtin_scene(o.scene) && std::filesystem::exists(o.scene, unreadable);
  const Scene scene = is_file ? load_gltf(o.scene, -1, chosen_limits(o), &extensions) : load_scene(o);
  if (o.json.empty()) {
    print_info(scene, o, extensions);
  } else {
    write_json(o.json,
               info_json(scene, o, extensions).dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
  return 0;
}

}  // namespace

void add_scenes(CommandLine& line) {
  auto json = std::make_shared<std::string>();
  Subcommand command = line.add("scenes", "the built-in scenes", [json] { return list_scenes(*json); });
  command.option("--json", *json, "as JSON into a file, - for stdout");
}

void add_info(CommandLine& line) {
  auto o = std::make_shared<InfoOptions>();
  Subcommand command =
      line.add("info", "what a scene or file holds: cameras, lights, extent, animations, extensions",
               [o] { return info(*o); });
  command.option("scene", o->scene, "a .gltf or .glb file, or a built-in scene");
  add_file_options(command, *o);
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
