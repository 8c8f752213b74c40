// The options of `lightgrid frontier`, and the sweep that follows from them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/options.h"
#include "frontier/measure.h"

namespace lightgrid::app {

struct FrontierCommand {
  SceneChoice scene;                // shared by all scenes
  std::vector<std::string> scenes;  // or "merge" and folders, or "export" and scenes
  DeviceOptions devices;
  std::string output = "out/frontier", json, gate, shard = "0/1", process, truth, baseline;
  std::string half_width = "1";  // per cent
  std::string keep = "range";    // over the numbers of lights of the growth (Kept)
  std::vector<std::string> techniques, vary, external;
  int views = 16, rounds = 120, budget = 14, page_mb = 12, processes = 1;
  bool no_growth = false, sequences = false, families = false;
};

using Externals = std::vector<std::shared_ptr<const lab::ExternalRenderer>>;

struct Shard {
  int index = 0, count = 1;
};

// "I/N", of `what`. Throws Error(input).
Shard parse_shard(const std::string& text, const char* what = "shard");

SceneChoice choice_of(const FrontierCommand& o, const std::string& scene);

// A scene's points, and what they are held to.
struct SceneRequest {
  std::vector<lab::ChosenPoint> points;
  lab::FrontierTruth truth;
  bool casts = false;  // some light of the scene
};

// The points of the techniques and settings that are named, of a family, or the default ones; `shadows`: for
// a scene whose lights cast.
std::vector<lab::ChosenPoint> points_of(const FrontierCommand& o, const Settings& common, bool opengl,
                                        const std::optional<lab::FrontierTruth>& shadows = {});
SceneRequest request_of_scene(const FrontierCommand& o, bool casts, const Settings& common, bool opengl);
void add_external_points(const Externals& externals, const std::string& scene, SceneRequest& request);

// "hall" of scenes/hall.glb, and another name for a second one.
std::filesystem::path folder_of_scene(const FrontierCommand& o, size_t scene);

// Parts of one sweep agree in this.
std::string request_of(const FrontierCommand& o, const std::vector<lab::ChosenPoint>& points,
                       const std::vector<SceneRequest>& of_scenes, const Externals& externals);

// Checks what the command is asked for, before a device opens and before the first scene is measured. Returns
// whether a light casts, scene by scene. Throws Error(input).
std::vector<bool> check_request(const FrontierCommand& o, const Externals& externals);

lab::FrontierJob job_of(const FrontierCommand& o, const Renderer& renderer, const Shard& shard);
// Gives the job the points of a scene that the shard measures.
void ask(lab::FrontierJob& job, const SceneRequest& request, const Shard& shard);

}  // namespace lightgrid::app
