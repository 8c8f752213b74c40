// Exports the data that another renderer needs to draw the pictures of a sweep: the scene as glTF, and its
// views (docs/put_your_renderer_on_the_plane.md#what-to-draw).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::lab {

// An exported scene, as far as requests need it.
struct ExportedScene {
  std::string name;              // as in the sweep
  std::filesystem::path folder;  // absolute; holds scene.glb and views.json
  glm::vec3 ambient{0}, background{0};
  std::vector<View> views;
};

// The name of the camera in scene.glb that is this view; empty if none is.
std::string camera_of(const ExportedScene& exported, const View& view);

// Size, near and far, clip_from_view, view_from_world and eye as in view.json of a captured frame
// (docs/frames.md); besides the camera's axes right, up and direction (ahead) in world space and, of a
// perspective view, fov_y_rad.
nlohmann::ordered_json view_json(const View& view);

// Writes scene.glb and views.json into the folder, which is created. The cameras of scene.glb are the views.
// `pictures`: of each view, names of files beside them by what they show; may be empty. Throws as glb_of and
// write_file do.
ExportedScene export_scene(const std::filesystem::path& folder, const std::string& name, const Scene& scene,
                           const std::vector<View>& views,
                           const std::vector<nlohmann::ordered_json>& pictures = {});

// Throws Error(input) that names the file and what differs, unless the views.json is of these lights and of
// these views, or of these and more.
void check_exported_views(const std::filesystem::path& path, const Scene& scene,
                          const std::vector<View>& views);

}  // namespace lightgrid::lab
