#include "frontier/export.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "base/write_file.h"
#include "frames/frame_view.h"
#include "frontier/record_file.h"
#include "scene/lights_file.h"
#include "scene/write_gltf.h"

namespace lightgrid::lab {
namespace {

using Ordered = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int max_views_depth = 8;
constexpr uintmax_t max_views_bytes = uintmax_t(16) << 20;
constexpr double same_number = 1e-9;  // another machine's sines

Ordered numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Another scene's pictures would be held against this one's.
std::string lights_hash(const Scene& scene) {
  return content_hash(lights_file_text(scene.lights) + Ordered(numbers(glm::dvec3(scene.ambient))).dump());
}

Camera named_camera(const View& view, const std::string& name) {
  Camera camera{.name = name};
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  camera.world_from_view = glm::dmat4(world_from_view);
  camera.world_from_view[3] = glm::dvec4(view.eye, 1);
  camera.orthographic = view.orthographic;
  camera.aspect = double(view.width) / view.height;
  camera.half_width_m = 1 / view.clip_from_view[0][0];
  camera.half_height_m = 1 / view.clip_from_view[1][1];
  camera.fov_y_rad = 2 * std::atan(1 / view.clip_from_view[1][1]);
  camera.near_m = view.near_m;
  camera.far_m = view.far_m;
  return camera;
}

std::string camera_name(size_t view) { return fmt::format("view {}", view); }

bool agree(const nlohmann::json& a, const nlohmann::json& b) {
  if (!a.is_array() || a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (!a[i].is_number()) return false;
    const double x = a[i].get<double>(), y = b[i].get<double>();
    if (!(std::abs(x - y) <= same_number * std::max(1.0, std::abs(y)))) return false;
  }
  return true;
}

}  // namespace

Ordered view_json(const View& view) {
  Ordered out = Ordered::parse(view_file_text({.view = view}));
  out.erase("tile");
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  out["right"] = numbers(world_from_view[0]);
  out["up"] = numbers(world_from_view[1]);
  out["direction"] = numbers(-world_from_view[2]);
  if (!view.orthographic) out["fov_y_rad"] = named_camera(view, "").fov_y_rad;
  return out;
}

ExportedScene export_scene(const fs::path& folder, const std::string& name, const Scene& scene,
                           const std::vector<View>& views, const std::vector<Ordered>& pictures) {
  make_folder(folder);
  Scene exported = scene;
  exported.name = name;
  exported.cameras.clear();
  Ordered all = Ordered::array();
  for (size_t i = 0; i < views.size(); ++i) {
    exported.cameras.push_back(named_camera(views[i], camera_name(i)));
    Ordered entry = {{"view", i}, {"camera", camera_name(i)}};
    entry.update(view_json(views[i]));
    if (i < pictures.size()) entry.update(pictures[i]);
    all.push_back(entry);
  }
  write_file(folder / "scene.glb", glb_of(exported));
  const Ordered file = {{"lightgrid_views", 1},
                        {"name", name},
                        {"scene", "scene.glb"},
                        {"lights", scene.lights.size()},
                        {"lights_hash", lights_hash(scene)},
                        {"ambient", numbers(glm::dvec3(scene.ambient))},
                        {"background", numbers(glm::dvec3(scene.background))},
                        {"views", all}};
  write_file(folder / "views.json", file.dump(1, ' ', false, Ordered::error_handler_t::replace) + "\n");
  return {name, fs::absolute(folder), scene.ambient, scene.background, views};
}

std::string camera_of(const ExportedScene& exported, const View& view) {
  const auto found = std::ranges::find(exported.views, view);
  return found == exported.views.end() ? "" : camera_name(size_t(found - exported.views.begin()));
}

void check_exported_views(const fs::path& path, const Scene& scene, const std::vector<View>& views) {
  const std::string where = path.string() + ": ";
  const nlohmann::json parsed =
      parsed_json(read_small_file(path, max_views_bytes, "a file of views"), max_views_depth, where);
  const JsonFields file(parsed, where);
  if (file.whole("lightgrid_views", 0) != 1) throw input_error("{}lightgrid_views: is not 1", where);
  if (file.text("lights_hash") != lights_hash(scene))
    throw input_error("{}has other lights than this sweep: {}, here {}; export it again", where,
                      file.whole("lights", 0), scene.lights.size());
  const nlohmann::json& all = file.at("views");
  if (!all.is_array() || all.size() < views.size())
    throw input_error("{}has {} views, the sweep {}: export as many, or give --views {}", where,
                      all.is_array() ? all.size() : 0, views.size(), all.is_array() ? all.size() : 0);
  for (size_t i = 0; i < views.size(); ++i) {
    const nlohmann::json own = view_json(views[i]);
    const JsonFields entry(all[i], fmt::format("{}views[{}].", where, i));
    for (const char* key : {"size", "clip_from_view", "view_from_world", "eye"}) {
      if (!agree(entry.at(key), own.at(key)))
        throw input_error(
            "{}views[{}].{}: is not that of this sweep's view: export with its --size, --views "
            "and camera",
            where, i, key);
    }
  }
}

}  // namespace lightgrid::lab
