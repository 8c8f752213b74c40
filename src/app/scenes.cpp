// lightgrid scenes: the built-in scenes and their contents.
#include <fmt/format.h>

#include <memory>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "scene/builtin.h"

namespace lightgrid {
namespace {

struct Row {
  const BuiltinScene* scene;
  size_t triangles = 0, point = 0, spot = 0, directional = 0;
  std::vector<std::string> cameras;
};

Row describe(const BuiltinScene& builtin) {
  const Scene scene = builtin.make();
  Row row{&builtin};
  for (const Instance& i : scene.instances) row.triangles += scene.meshes[i.mesh].indices.size() / 3;
  for (const Light& light : scene.lights) {
    row.point += light.type == LightType::point;
    row.spot += light.type == LightType::spot;
    row.directional += light.type == LightType::directional;
  }
  for (const Camera& camera : scene.cameras) row.cameras.push_back(camera.name);
  return row;
}

nlohmann::ordered_json to_json(const Row& row) {
  return {{"name", row.scene->name},
          {"summary", row.scene->summary},
          {"triangles", row.triangles},
          {"lights",
           {{"total", row.point + row.spot + row.directional},
            {"point", row.point},
            {"spot", row.spot},
            {"directional", row.directional}}},
          {"cameras", row.cameras}};
}

int list_scenes(const std::string& json) {
  auto rows = nlohmann::ordered_json::array();
  if (json.empty())
    fmt::print("{:<8} {:>9} {:>6}  {}\n", "scene", "triangles", "lights", "contents and cameras");
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Row row = describe(builtin);
    rows.push_back(to_json(row));
    if (!json.empty()) continue;
    fmt::print("{:<8} {:>9} {:>6}  {} ({})\n", row.scene->name, row.triangles,
               row.point + row.spot + row.directional, row.scene->summary, fmt::join(row.cameras, ", "));
  }
  if (!json.empty()) write_json(json, rows.dump(1));
  return 0;
}

}  // namespace

void add_scenes(CommandLine& line) {
  auto json = std::make_shared<std::string>();
  Subcommand command = line.add("scenes", "the built-in scenes", [json] { return list_scenes(*json); });
  command.option("--json", *json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid
