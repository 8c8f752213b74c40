// The options that every subcommand on a scene shares (docs/command_line.md), and what they name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "gl/context.h"
#include "plan/settings.h"
#include "compare/compare.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid {

struct SceneOptions {
  std::string scene = "hall";
  std::string size = "1280x720";
  std::string camera;
  std::string camera_path;  // empty: a camera at rest
  std::string time;         // seconds; empty: at rest
  std::string light_motion = "none";
  int lights = -1;  // -1: as the scene has them
  std::string lights_file;
  std::string light_radius;
  uint64_t seed = 1;
  std::string brdf;  // empty: ggx, or as --set has it
  std::vector<std::string> set;
};

struct DeviceOptions {
  std::string device;
  std::string gl = "auto";
};

struct TimingOptions {
  int frames = 5;
  int warmup = 1;
};

inline constexpr int most_lights = 10'000'000;

void add_scene_options(Subcommand& command, SceneOptions& options);
void add_view_options(Subcommand& command, SceneOptions& options);  // of those, all but scene, size and lights
void add_path_option(Subcommand& command, SceneOptions& options);
void add_device_options(Subcommand& command, DeviceOptions& options);
void add_timing_options(Subcommand& command, TimingOptions& options);

// What the options name. Throw Error(input) that names the option and the value.
struct ImageSize {
  int width = 0, height = 0;
};
ImageSize parse_size(const std::string& text);
Scene load_scene(const std::string& name);
// The view of a loaded scene, whose lights become those that the options ask for.
View choose_view(Scene& scene, const SceneOptions& options);
// The scene's motion along a path, 30 frames a second from the chosen time on; empty where nothing moves. The scene outlives it.
SceneMotion chosen_motion(Scene& scene, const SceneOptions& options);
// The views of the camera path, or none.
std::vector<View> chosen_path(const Scene& scene, const View& start, const SceneOptions& options);
struct ChosenScene {
  Scene scene;
  View view;
};
ChosenScene load_chosen_scene(const SceneOptions& options);
Settings chosen_settings(const SceneOptions& options);

// Throws Error(input) if the file `path`, given by `option`, could not be created: its folder is missing, not a folder
// or not writable, or it is a folder itself. Call it before long work; "-" is always valid.
void check_output_file(const std::string& option, const std::filesystem::path& path);

// Writes JSON text to a file, or to stdout for "-".
void write_json(const std::string& destination, const std::string& text);

}  // namespace lightgrid
