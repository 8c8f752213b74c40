#include "app/options.h"

#include <unistd.h>

#include <cerrno>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/log.h"
#include "scene/builtin.h"
#include "scene/camera_path.h"
#include "scene/light_motion.h"
#include "scene/light_rigs.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"

namespace lightgrid {
namespace {

constexpr int max_image_side = 16384;

// Parses two numbers with a separator between them, and nothing else.
template <typename T>
bool parse_pair(const std::string& text, char separator, T& a, T& b) {
  const char *begin = text.data(), *end = begin + text.size();
  const auto first = std::from_chars(begin, end, a);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != separator) return false;
  const auto second = std::from_chars(first.ptr + 1, end, b);
  return second.ec == std::errc() && second.ptr == end;
}

void check_light_radius(const SceneOptions& o) {
  if (!o.light_radius.empty() && (o.lights < 0 || !o.lights_file.empty())) {
    throw input_error("--light-radius {}: only lights that --lights scatters take it", o.light_radius);
  }
}

void scatter_over(Scene& scene, const SceneOptions& o) {
  ScatterSettings scatter;
  scatter.count = o.lights;
  scatter.seed = o.seed;
  float &low = scatter.min_radius_m, &high = scatter.max_radius_m;
  if (!o.light_radius.empty() && (!parse_pair(o.light_radius, ',', low, high) || !(low > 0) || !(high >= low) || std::isinf(high))) {
    throw input_error("--light-radius {}: not MIN,MAX in metres with 0 < MIN <= MAX", o.light_radius);
  }
  scene.lights = scatter_lights(scene, scatter);
}

void load_lights(Scene& scene, const SceneOptions& o) {
  scene.lights = load_lights_file(o.lights_file);
  if (o.lights < 0) return;
  if (size_t(o.lights) > scene.lights.size()) {
    throw input_error("--lights {}: {} holds only {}", o.lights, o.lights_file, scene.lights.size());
  }
  scene.lights.resize(o.lights);
}

double parse_time(const std::string& text) {
  double seconds = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (failure != std::errc() || end != text.data() + text.size() || !(seconds >= 0) || !(seconds <= 1e9)) {
    throw input_error("--time {}: not a number of seconds from 0 to 1e9", text);
  }
  return seconds;
}

}  // namespace

Scene load_scene(const std::string& name) {
  if (const BuiltinScene* builtin = find_builtin_scene(name)) return builtin->make();
  std::error_code unreadable;  // a name too long, or a folder closed to us, is no file either
  if (!std::filesystem::exists(name, unreadable)) {
    std::string names;
    for (const BuiltinScene& s : builtin_scenes()) names += (names.empty() ? "" : ", ") + std::string(s.name);
    throw input_error("{}: no such file, and no built-in scene of that name; there are {}", name, names);
  }
  return load_gltf(name);
}

void add_scene_options(Subcommand& command, SceneOptions& o) {
  command.option("scene", o.scene, "a .gltf or .glb file, or a built-in scene");
  command.option("--size", o.size, "image size, WxH");
  command.option("--lights", o.lights, "scatter N lights; with --lights-file, its first N", 0, most_lights);
  add_view_options(command, o);
}

void add_view_options(Subcommand& command, SceneOptions& o) {
  command.option("--camera", o.camera, "name, index or eye:x,y,z,target:x,y,z,fov:degrees");
  command.option("--lights-file", o.lights_file, "lights as JSON, instead of the scene's own");
  command.option("--light-radius", o.light_radius, "range of scattered lights in metres, MIN,MAX");
  command.option("--seed", o.seed, "of the scatter");
  command.option("--brdf", o.brdf, "ggx or blinn: short for --set brdf=…");
  command.option("--time", o.time, "seconds into the animations of the file; not given: at rest");
  command.list("--set", o.set, "a setting, KEY=VALUE; may be repeated");
}

void add_path_option(Subcommand& command, SceneOptions& o) {
  command.option("--light-motion", o.light_motion, "lights that move along the path: none, orbit or drift");
  command.option("--camera-path", o.camera_path, "a camera that moves: turn:N, dolly:N or a JSON file of keys");
}

void add_device_options(Subcommand& command, DeviceOptions& o) {
  command.option("--device", o.device, "OpenCL device, by a part of its name");
  command.option("--gl", o.gl, "osmesa, egl or auto");
}

void add_timing_options(Subcommand& command, TimingOptions& o) {
  command.option("--frames", o.frames, "frames to time", 1, 10000);
  command.option("--warmup", o.warmup, "frames before those", 0, 10000);
}

ImageSize parse_size(const std::string& text) {
  ImageSize size;
  if (!parse_pair(text, 'x', size.width, size.height) || size.width < 1 || size.height < 1 || size.width > max_image_side ||
      size.height > max_image_side) {
    throw input_error("--size {}: not WxH with sides from 1 to {}", text, max_image_side);
  }
  return size;
}

View choose_view(Scene& scene, const SceneOptions& o) {
  const ImageSize size = parse_size(o.size);
  if (!o.time.empty()) set_time(scene, parse_time(o.time));
  check_light_radius(o);
  std::string camera = o.camera;
  if (!o.lights_file.empty()) {
    load_lights(scene, o);
    if (camera.empty()) camera = camera_of_lights_file(o.lights_file);
  } else if (o.lights >= 0) {
    scatter_over(scene, o);
  }
  const View view = make_view(choose_camera(scene, camera, double(size.width) / size.height), size.width, size.height);
  if (scene.lights.empty() && o.lights < 0 && o.lights_file.empty()) {
    log_info("{}: no lights; adding a key and a fill light from beside the camera (--lights 0 for none)", o.scene);
    DefaultLights added = default_lights(view);
    scene.lights = std::move(added.lights);
    scene.ambient = added.ambient;
  }
  return view;
}

SceneMotion chosen_motion(Scene& scene, const SceneOptions& o) {
  const LightMotion motion = light_motion(o.light_motion);
  const bool animated = !o.time.empty() && animation_count(scene) > 0;
  if (motion == LightMotion::none && !animated) return {};
  const double start = o.time.empty() ? 0 : parse_time(o.time);
  constexpr double frames_a_second = 30;
  return [&scene, animated, start, rig = make_light_rig(scene, motion)](size_t frame) {
    const double seconds = start + double(frame) / frames_a_second;
    SceneChanges changes;
    if (animated) changes = set_time(scene, looped_time(scene, seconds));
    const SceneChanges lights = move_lights(scene, rig, seconds);
    changes.lights.insert(changes.lights.end(), lights.lights.begin(), lights.lights.end());
    std::ranges::sort(changes.lights);
    return changes;
  };
}

std::vector<View> chosen_path(const Scene& scene, const View& start, const SceneOptions& o) {
  return o.camera_path.empty() ? std::vector<View>() : camera_path(scene, start, o.camera_path);
}

ChosenScene load_chosen_scene(const SceneOptions& o) {
  parse_size(o.size);  // what is wrong with these is told before the scene is loaded
  check_light_radius(o);
  ChosenScene chosen{load_scene(o.scene), {}};
  chosen.view = choose_view(chosen.scene, o);
  return chosen;
}

Settings chosen_settings(const SceneOptions& o) {
  Settings settings;
  for (const std::string& assignment : o.set) apply_setting(settings, assignment);
  if (!o.brdf.empty()) apply_setting(settings, "brdf=" + o.brdf);
  return settings;
}

void check_output_file(const std::string& option, const std::filesystem::path& path) {
  if (path == "-") return;
  std::error_code unreadable;
  if (std::filesystem::is_directory(path, unreadable)) throw input_error("{} {}: is a folder, not a file", option, path.string());
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, unreadable)) {
    throw input_error("{} {}: there is no folder {}", option, path.string(), folder.string());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw input_error("{} {}: no file can be made in {}: {}", option, path.string(), folder.string(), std::strerror(errno));
  }
}

void write_json(const std::string& destination, const std::string& text) {
  const std::string whole = text.ends_with('\n') ? text : text + '\n';
  if (destination == "-") {
    std::fwrite(whole.data(), 1, whole.size(), stdout);
    return;
  }
  std::ofstream file(destination);
  file << whole;
  if (!file.flush()) throw input_error("--json {}: cannot be written", destination);
}

}  // namespace lightgrid
