#include "session/scene_choice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

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

void check_light_radius(const SceneChoice& choice) {
  if (!choice.light_radius.empty() && (choice.lights < 0 || !choice.lights_file.empty())) {
    throw input_error("light-radius {}: applies only to lights that \"lights\" scatters",
                      choice.light_radius);
  }
}

void scatter_over(Scene& scene, const SceneChoice& choice) {
  ScatterSettings scatter;
  scatter.count = choice.lights;
  scatter.seed = choice.seed;
  float &low = scatter.min_radius_m, &high = scatter.max_radius_m;
  if (!choice.light_radius.empty() && (!parse_pair(choice.light_radius, ',', low, high) || !(low > 0) ||
                                       !(high >= low) || std::isinf(high))) {
    throw input_error("light-radius {}: not MIN,MAX in metres with 0 < MIN <= MAX", choice.light_radius);
  }
  scene.lights = scatter_lights(scene, scatter);
}

void load_lights(Scene& scene, const SceneChoice& choice) {
  scene.lights = load_lights_file(choice.lights_file);
  if (choice.lights < 0) return;
  if (size_t(choice.lights) > scene.lights.size()) {
    throw input_error("lights {}: {} has only {}", choice.lights, choice.lights_file, scene.lights.size());
  }
  scene.lights.resize(choice.lights);
}

float parse_ambient(const std::string& text) {
  float radiance = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), radiance);
  if (failure != std::errc() || end != text.data() + text.size() || !(radiance >= 0) || std::isinf(radiance))
    throw input_error("ambient {}: not a finite radiance of 0 or more", text);
  return radiance;
}

}  // namespace

std::optional<double> chosen_time(const SceneChoice& choice) {
  const std::string& text = choice.time;
  if (text.empty()) return {};
  double seconds = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (failure != std::errc() || end != text.data() + text.size() || !(seconds >= 0) || !(seconds <= 1e9)) {
    throw input_error("time {}: not a number of seconds from 0 to 1e9", text);
  }
  return seconds;
}

Scene load_scene(const std::string& name) {
  if (const BuiltinScene* builtin = find_builtin_scene(name)) return builtin->make();
  std::error_code unreadable;  // a name too long, or an unreadable folder, is no file either
  if (!std::filesystem::exists(name, unreadable)) {
    std::string names;
    for (const BuiltinScene& s : builtin_scenes()) names += (names.empty() ? "" : ", ") + std::string(s.name);
    throw input_error("{}: no such file, and no built-in scene of that name; there are {}", name, names);
  }
  return load_gltf(name);
}

ImageSize parse_size(const std::string& text) {
  ImageSize size;
  if (!parse_pair(text, 'x', size.width, size.height) || size.width < 1 || size.height < 1 ||
      size.width > max_image_side || size.height > max_image_side) {
    throw input_error("size {}: not WxH with sides from 1 to {}", text, max_image_side);
  }
  return size;
}

View choose_view(Scene& scene, const SceneChoice& choice) {
  const ImageSize size = parse_size(choice.size);
  if (const auto seconds = chosen_time(choice)) set_time(scene, seconds);
  check_light_radius(choice);
  std::string camera = choice.camera;
  if (!choice.lights_file.empty()) {
    load_lights(scene, choice);
    if (camera.empty()) camera = camera_of_lights_file(choice.lights_file);
  } else if (choice.lights >= 0) {
    scatter_over(scene, choice);
  }
  const View view =
      make_view(choose_camera(scene, camera, double(size.width) / size.height), size.width, size.height);
  if (scene.lights.empty() && choice.lights < 0 && choice.lights_file.empty()) {
    log_info("{}: no lights; adding a key and a fill light fixed to the camera (lights 0: none)",
             choice.scene);
    DefaultLights added = default_lights(view);
    scene.lights = std::move(added.lights);
    scene.ambient = added.ambient;
  }
  if (!choice.ambient.empty()) scene.ambient = glm::vec3(parse_ambient(choice.ambient));
  return view;
}

SceneMotion chosen_motion(Scene& scene, const SceneChoice& choice) {
  const LightMotion motion = light_motion(choice.light_motion);
  const std::optional<double> time = chosen_time(choice);
  const bool animated = time && animation_count(scene) > 0;
  if (motion == LightMotion::none && !animated) return {};
  const double start = time.value_or(0);
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

std::vector<View> chosen_path(const Scene& scene, const View& start, const SceneChoice& choice) {
  return choice.camera_path.empty() ? std::vector<View>() : camera_path(scene, start, choice.camera_path);
}

ChosenScene load_chosen_scene(const SceneChoice& choice) {
  parse_size(choice.size);  // reports faults in these before the scene is loaded
  check_light_radius(choice);
  if (!choice.ambient.empty()) parse_ambient(choice.ambient);
  ChosenScene chosen{load_scene(choice.scene), {}};
  chosen.view = choose_view(chosen.scene, choice);
  return chosen;
}

Settings chosen_settings(const SceneChoice& choice) {
  Settings settings;
  for (const std::string& assignment : choice.set) apply_setting(settings, assignment);
  if (!choice.brdf.empty()) apply_setting(settings, "brdf=" + choice.brdf);
  return settings;
}

Renderer open_devices(const DeviceOptions& o, const std::string& technique, const Settings& settings) {
  const bool opengl = technique.empty() || draws_with_opengl(find_technique(technique).needs, settings);
  const GlBackend wanted = parse_gl_backend(o.gl);
  Renderer renderer(o.device, !opengl && wanted == GlBackend::automatic ? GlBackend::none : wanted);
  if (opengl && !technique.empty()) renderer.require_gl();
  return renderer;
}

const Technique& technique_or_default(const std::string& technique, const Renderer& renderer) {
  if (!technique.empty()) return find_technique(technique);
  if (renderer.gl) return find_technique("forward_plus");
  log_warning("{}; visibility takes the place of forward_plus", renderer.why_no_gl);
  return find_technique("visibility");
}

}  // namespace lightgrid
