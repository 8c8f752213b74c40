#include "run/scene_choice.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "plan/coarse_shadows.h"
#include "plan/settings/model.h"
#include "plan/settings/picture.h"
#include "scene/camera_path.h"
#include "scene/environment_light.h"
#include "scene/light_motion.h"
#include "scene/light_rigs.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "scene/shadow_casters.h"
#include "scenes/builtin.h"

namespace lightgrid {

namespace {

constexpr int max_image_side = 16384;

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
  scatter.ranges_of = choice.ranges_of;
  if (!choice.light_radius.empty()) {
    const auto [low, high] = parse_pair<float>(choice.light_radius, ',').value_or(std::pair(0.0f, 0.0f));
    if (!(low > 0) || !(high >= low) || std::isinf(high))
      throw input_error("light-radius {}: not MIN,MAX in metres with 0 < MIN <= MAX", choice.light_radius);
    scatter.min_radius_m = low;
    scatter.max_radius_m = high;
  }
  scene.lights = scatter_lights(scene, scatter);
}

void load_lights(Scene& scene, const SceneChoice& choice) {
  load_lights(scene, choice.lights_file);
  if (choice.lights < 0) return;
  if (size_t(choice.lights) > scene.lights.size()) {
    throw input_error("lights {}: {} has only {}", choice.lights, choice.lights_file, scene.lights.size());
  }
  scene.lights.resize(choice.lights);
}

float parse_ambient(const std::string& text) {
  const auto radiance = parse_number<float>(text);
  if (!radiance || !(*radiance >= 0) || std::isinf(*radiance))
    throw input_error("ambient {}: not a finite radiance of 0 or more", text);
  return *radiance;
}

constexpr double max_exposure = 60;

// Stops; empty: automatic.
std::optional<double> parse_exposure(const SceneChoice& choice) {
  if (choice.exposure.empty() && find_builtin_scene(choice.scene)) return 0;
  if (choice.exposure.empty() || choice.exposure == "auto") return {};
  const auto ev = parse_number<double>(choice.exposure);
  if (!ev || !(std::abs(*ev) <= max_exposure))
    throw input_error("exposure {}: neither auto nor a number of stops from {} to {}", choice.exposure,
                      -max_exposure, max_exposure);
  return ev;
}

// Many lights without a range are in every list, so that no technique can be faster than another.
void tell_endless_lights(const Scene& scene, const SceneChoice& choice) {
  constexpr ptrdiff_t many = 32;
  const auto endless = std::ranges::count_if(
      scene.lights, [](const Light& l) { return !is_directional(l) && std::isinf(l.radius_m); });
  if (endless < many || chosen_settings(choice)[setting::range] != LightRange::scene) return;
  const std::vector<CutoffEffect> help = helpful_cutoffs(scene);
  const std::string line =
      fmt::format("{}: {} of {} lights have no range: every technique lists them at any distance",
                  choice.scene, endless, scene.lights.size());
  if (help.empty()) return log_warning_line(line);
  const auto setting = [](const CutoffEffect& e) { return fmt::format("cutoff={:g}", e.cutoff); };
  std::string effects = fmt::format(
      "with --set range=cutoff --set {} about {:.0f} reach a point, which keeps {:.0f} % of its light",
      setting(help[0]), help[0].lights, 100 * help[0].share);
  for (size_t i = 1; i < help.size(); ++i)
    effects += fmt::format("; with {} about {:.0f}, which keep {:.0f} %", setting(help[i]), help[i].lights,
                           100 * help[i].share);
  log_warning_line(line + "; " + effects, {"range=cutoff", setting(help[0])});
}

void replace_ambient_by_sky(Scene& scene) {
  if (scene.environment || scene.ambient == glm::vec3(0)) return;
  scene.environment = make_environment(sky_of_mean(glm::dvec3(scene.ambient)));
  scene.ambient = glm::vec3(0);
}

VirtualLightSettings virtual_settings(const SceneChoice& choice) {
  VirtualLightSettings s{.count = choice.virtual_lights, .seed = choice.seed};
  for (const auto& [name, text] :
       {std::pair("from", choice.virtual_from), {"nearest", choice.virtual_nearest}}) {
    if (!text.empty() && choice.virtual_lights == 0)
      throw input_error("virtual-{} {}: applies only to lights that \"virtual-lights\" places", name, text);
  }
  if (!choice.virtual_from.empty() && choice.virtual_from != "all") {
    const auto from = parse_number<int>(choice.virtual_from);
    if (!from || *from < 1 || *from > max_lights)
      throw input_error("virtual-from {}: neither all nor a number of lights from 1 to {}",
                        choice.virtual_from, max_lights);
    s.from = size_t(*from);
  }
  if (!choice.virtual_nearest.empty() && choice.virtual_nearest != "auto") {
    const auto nearest = parse_number<float>(choice.virtual_nearest);
    if (!nearest || !(*nearest >= 0) || std::isinf(*nearest))
      throw input_error("virtual-nearest {}: neither auto nor metres of 0 or more", choice.virtual_nearest);
    s.nearest_m = double(*nearest);
  }
  return s;
}

void place_virtual_lights(Scene& scene, const SceneChoice& choice) {
  const std::unique_ptr<VirtualLights> placed = chosen_virtual_lights(scene, choice);
  if (!placed) return;
  placed->place();
  if (placed->reflected() == 0)
    log_warning("virtual-lights {}: {} has no point or spot light that surfaces could reflect",
                choice.virtual_lights, choice.scene);
}

}  // namespace

Kept parse_kept(const std::string& keep, const SceneChoice& choice) {
  if (keep == name_of(Kept::range)) return Kept::range;
  if (keep != name_of(Kept::overlap)) throw input_error("keep {}: neither range nor overlap", keep);
  for (const auto& [name, text] :
       {std::pair("light-radius", choice.light_radius), {"lights-file", choice.lights_file}}) {
    if (!text.empty()) throw input_error("keep {}: {} {} gives the lights their ranges", keep, name, text);
  }
  return Kept::overlap;
}

const char* name_of(Kept kept) { return kept == Kept::range ? "range" : "overlap"; }

const std::vector<ChoiceField>& choice_fields() {
  using enum ChoiceField::Of;
  static const std::vector<ChoiceField> fields = {
      {"size", "image size, WxH", scene, &SceneChoice::size},
      {"lights", "scatter N lights; with --lights-file, its first N", scene, &SceneChoice::lights,
       max_lights},
      {"files", "files that a glTF file may name: below (its folder; default) or anywhere", file,
       &SceneChoice::files},
      {"image-memory", "memory for decoded images, such as 4G (default: depends on free memory)", file,
       &SceneChoice::image_memory},
      {"texture-size", "largest side of an image: larger ones are averaged down", file,
       &SceneChoice::texture_size, GltfLimits().texture_side},
      {"camera", "name, index or eye:x,y,z,target:x,y,z,fov:degrees,near:metres", view, &SceneChoice::camera},
      {"lights-file", "lights as JSON, instead of the scene's own", view, &SceneChoice::lights_file},
      {"light-radius", "range of scattered lights in metres, MIN,MAX", view, &SceneChoice::light_radius},
      {"ambient", "radiance from all sides instead of the scene's own; 0: none", view, &SceneChoice::ambient},
      {"environment",
       "light from surroundings in place of ambient light: an .hdr or .exr picture, sky, sky:COLOURS or none",
       view, &SceneChoice::environment},
      {"shadows", "lights that cast shadows: the N most important, all or none (default: as the scene says)",
       view, &SceneChoice::shadows},
      {"virtual-lights", "adds N virtual point lights where surfaces reflect the others", view,
       &SceneChoice::virtual_lights, max_virtual_lights},
      {"virtual-from", "lights that are reflected: the N most important, or all (default)", view,
       &SceneChoice::virtual_from},
      {"virtual-nearest",
       "smallest distance used for a virtual light, in metres, or auto: the radius of the patch that it "
       "stands for (default)",
       view, &SceneChoice::virtual_nearest},
      {"seed", "seed of the scatter, and of the places of virtual lights", view, &SceneChoice::seed},
      {"brdf", "ggx, blinn or lambert: short for --set brdf=…", view, &SceneChoice::brdf},
      {"time", "seconds into the animations of the file; not given: at rest", view, &SceneChoice::time},
      {"exposure",
       "exposure of pictures, in stops: linear values times 2^EV, or auto (default: auto for files, 0 for "
       "built-in scenes)",
       picture, &SceneChoice::exposure},
      {"light-motion", "lights that move: none, orbit or drift", path, &SceneChoice::light_motion},
      {"camera-path", "a moving camera: turn:N, dolly:N or a JSON file of keys", path,
       &SceneChoice::camera_path},
  };
  return fields;
}

void set_choice_field(SceneChoice& choice, const std::string& assignment) {
  const size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string name = assignment.substr(0, equals);
  const auto& fields = choice_fields();
  const auto field = std::ranges::find_if(fields, [&](const ChoiceField& f) { return f.name == name; });
  if (equals == assignment.size() || field == fields.end()) {
    std::vector<std::string> names;
    for (const ChoiceField& f : fields) names.emplace_back(f.name);
    throw input_error("{}: not NAME=VALUE with the name of a field{}; fields are {}", assignment,
                      did_you_mean(name, names), fmt::join(names, ", "))
        .about(name);
  }
  const std::string value = assignment.substr(equals + 1);
  if (value.empty() && name != "camera")
    throw input_error("{} is empty: leave it out for its default", name).about(name);
  if (const auto* text = std::get_if<std::string SceneChoice::*>(&field->value)) {
    choice.*(*text) = value;
  } else if (const auto* whole = std::get_if<int SceneChoice::*>(&field->value)) {
    const auto number = parse_number<int>(value);
    if (!number || *number < 0 || *number > field->most)
      throw input_error("{} {}: not a number from 0 to {}", name, value, field->most).about(name);
    choice.*(*whole) = *number;
  } else {
    const auto number = parse_number<uint64_t>(value);
    if (!number) throw input_error("{} {}: not a whole number of 64 bits", name, value).about(name);
    choice.*std::get<uint64_t SceneChoice::*>(field->value) = *number;
  }
}

std::unique_ptr<VirtualLights> chosen_virtual_lights(Scene& scene, const SceneChoice& choice) {
  const VirtualLightSettings settings = virtual_settings(choice);
  if (settings.count == 0) return nullptr;
  return std::make_unique<VirtualLights>(scene, choice.device, chosen_settings(choice), settings);
}

std::optional<size_t> chosen_casters(const std::string& text) {
  if (text.empty()) return {};
  if (text == "all") return size_t(max_lights);
  if (text == "none") return 0;
  const auto count = parse_number<int>(text);
  if (!count || *count < 0 || *count > max_lights)
    throw input_error("shadows {}: neither all, none nor a number of lights from 0 to {}", text, max_lights);
  return size_t(*count);
}

Exposure chosen_exposure(const SceneChoice& choice, const Image& image) {
  const std::optional<double> ev = parse_exposure(choice);
  return ev ? Exposure{*ev} : automatic_exposure(image);
}

void tell_exposure(const Exposure& exposure, const std::string& view) {
  if (!exposure.automatic || exposure.ev == 0) return;
  log_info(
      "{}pictures are exposed by {:+g} EV, chosen from the picture (--exposure {:g} keeps it, 0 is none)",
      view, exposure.ev, exposure.ev);
}

std::optional<double> chosen_time(const SceneChoice& choice) {
  const std::string& text = choice.time;
  if (text.empty()) return {};
  const auto seconds = parse_number<double>(text);
  if (!seconds || !(*seconds >= 0) || !(*seconds <= 1e9))
    throw input_error("time {}: not a number of seconds from 0 to 1e9", text);
  return seconds;
}

namespace {

// Empty: none given.
size_t parse_image_memory(const std::string& text) {
  if (text.empty()) return 0;
  constexpr std::string_view units = "KMG";
  const size_t unit = units.find(text.back());
  const bool has_unit = unit != std::string_view::npos;
  const auto number = parse_number<uint64_t>(std::string_view(text).substr(0, text.size() - has_unit));
  const int shift = has_unit ? 10 * int(unit + 1) : 0;
  if (!number || *number == 0 || *number > uint64_t(1) << 50 >> shift)
    throw input_error("image-memory {}: not a number of bytes, or of K, M or G of them", text);
  return size_t(*number) << shift;
}

}  // namespace

GltfLimits chosen_limits(const SceneChoice& choice) {
  if (!choice.files.empty() && choice.files != "below" && choice.files != "anywhere")
    throw input_error("files {}: neither below (the glTF file's folder) nor anywhere", choice.files);
  GltfLimits limits{.max_image_bytes = parse_image_memory(choice.image_memory),
                    .files_anywhere = choice.files == "anywhere"};
  if (choice.texture_size > 0) limits.texture_side = choice.texture_size;
  return limits;
}

Scene load_scene(const SceneChoice& choice) {
  const std::string& name = choice.scene;
  const GltfLimits limits = chosen_limits(choice);
  if (const BuiltinScene* builtin = find_builtin_scene(name)) return builtin->make();
  std::error_code unreadable;  // a name too long, or an unreadable folder, is no file either
  if (!std::filesystem::exists(name, unreadable)) {
    std::vector<std::string> names;
    for (const BuiltinScene& s : builtin_scenes()) names.emplace_back(s.name);
    throw input_error("{}: no such file, and no built-in scene of that name{}; there are {}", name,
                      did_you_mean(name, names), fmt::join(names, ", "))
        .about("scene");
  }
  return load_gltf(name, -1, limits);
}

ImageSize parse_size(const std::string& text) {
  const auto [width, height] = parse_pair<int>(text, 'x').value_or(std::pair(0, 0));
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side)
    throw input_error("size {}: not WxH with sides from 1 to {}", text, max_image_side);
  return {width, height};
}

View choose_view(Scene& scene, const SceneChoice& choice) {
  const ImageSize size = parse_size(choice.size);
  parse_exposure(choice);
  if (const auto seconds = chosen_time(choice)) {
    set_time(scene, seconds);
    if (animation_count(scene) == 0 && choice.light_motion == "none")
      log_warning("time {}: {} has no animation; it changes nothing", choice.time, choice.scene);
  }
  check_light_radius(choice);
  std::string camera = choice.camera;
  if (!choice.lights_file.empty()) {
    load_lights(scene, choice);
    if (camera.empty()) camera = camera_of_lights_file(choice.lights_file);
  } else if (choice.lights >= 0) {
    scatter_over(scene, choice);
  }
  const Camera chosen = choose_camera(scene, camera, double(size.width) / size.height);
  if (camera.empty() && scene.cameras.empty()) {
    const glm::dvec3 eye(chosen.world_from_view[3]), target = eye - glm::dvec3(chosen.world_from_view[2]);
    log_info("{}: no camera; {} (--camera eye:{:.6g},{:.6g},{:.6g},target:{:.6g},{:.6g},{:.6g})",
             choice.scene,
             chosen.name == "room" ? "the eye stands in the room" : "the whole is seen from outside", eye.x,
             eye.y, eye.z, target.x, target.y, target.z);
  }
  const View view = make_view(chosen, size.width, size.height);
  if (scene.lights.empty() && !scene.has_own_lights && choice.lights < 0 && choice.lights_file.empty()) {
    log_info("{}: no lights; adding a key and a fill light fixed to the camera (lights 0: none)",
             choice.scene);
    DefaultLights added = default_lights(view);
    scene.lights = std::move(added.lights);
    scene.ambient = added.ambient;
  }
  if (choice.environment == "sky:ambient") {
    replace_ambient_by_sky(scene);
  } else if (!choice.environment.empty()) {
    scene.environment = parse_environment(choice.environment);
    if (scene.environment) scene.ambient = glm::vec3(0);
  }
  if (!choice.ambient.empty()) scene.ambient = glm::vec3(parse_ambient(choice.ambient));
  place_virtual_lights(scene, choice);
  if (const auto casters = chosen_casters(choice.shadows)) choose_shadow_casters(scene, *casters);
  tell_endless_lights(scene, choice);
  if (const std::string coarse = describe(coarse_shadows(scene, ranges_of(chosen_settings(choice))), scene);
      !coarse.empty())
    log_warning("{}: {}", choice.scene, coarse);
  return view;
}

SceneMotion chosen_motion(Scene& scene, const SceneChoice& choice) {
  const LightMotion motion = light_motion(choice.light_motion);
  const std::optional<double> time = chosen_time(choice);
  const bool animated = time && animation_count(scene) > 0;
  if (motion == LightMotion::none && !animated) return {};
  const double start = time.value_or(0);
  constexpr double frames_a_second = 30;
  return [&scene, animated, start, rig = make_light_rig(scene, motion),
          reflected = std::shared_ptr(chosen_virtual_lights(scene, choice))](size_t frame) {
    const double seconds = start + double(frame) / frames_a_second;
    SceneChanges changes;
    if (animated) changes = set_time(scene, looped_time(scene, seconds));
    const SceneChanges lights = move_lights(scene, rig, seconds);
    changes.lights.insert(changes.lights.end(), lights.lights.begin(), lights.lights.end());
    std::ranges::sort(changes.lights);
    return reflected ? reflected->follow(std::move(changes)) : changes;
  };
}

std::vector<View> chosen_path(const Scene& scene, const View& start, const SceneChoice& choice) {
  if (!choice.camera_path.empty()) return camera_path(scene, start, choice.camera_path);
  if (light_motion(choice.light_motion) != LightMotion::none)
    log_warning("light-motion {}: lights move along a camera-path; without one they stand still",
                choice.light_motion);
  return {};
}

void check_choice(const SceneChoice& choice) {
  parse_size(choice.size);
  check_light_radius(choice);
  parse_exposure(choice);
  if (!choice.ambient.empty()) parse_ambient(choice.ambient);
  chosen_casters(choice.shadows);
  virtual_settings(choice);
  chosen_settings(choice);
  chosen_limits(choice);
  light_motion(choice.light_motion);
}

ChosenScene load_chosen_scene(const SceneChoice& choice) {
  check_choice(choice);
  ChosenScene chosen{load_scene(choice), {}};
  chosen.view = choose_view(chosen.scene, choice);
  return chosen;
}

Settings chosen_settings(const SceneChoice& choice) {
  Settings settings;
  for (const std::string& assignment : choice.set) apply_setting(settings, assignment);
  if (!choice.brdf.empty()) apply_setting(settings, "brdf=" + choice.brdf);
  settings.set(setting::display_ev, parse_exposure(choice));
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

static bool same_file(const SceneChoice& a, const SceneChoice& b) {
  return a.scene == b.scene && a.files == b.files && a.image_memory == b.image_memory &&
         a.texture_size == b.texture_size;
}

std::vector<LoadedView> load_views(const std::vector<SceneChoice>& choices) {
  std::vector<LoadedView> views;
  const SceneChoice* loaded = nullptr;
  std::vector<Warning> of_file;
  Scene own;  // the scene's own lights
  std::shared_ptr<Scene> scene;
  for (const SceneChoice& choice : choices) {
    if (!loaded || !same_file(choice, *loaded)) {
      const WarningCollector collector;
      scene = std::make_shared<Scene>(load_scene(choice));
      loaded = &choice;
      own.lights = scene->lights;
      own.ambient = scene->ambient;
      own.environment = scene->environment;
      of_file = collector.warnings();
    }
    const WarningCollector collector;
    scene->lights = own.lights;
    scene->ambient = own.ambient;
    scene->environment = own.environment;
    const View view = choose_view(*scene, choice);
    views.push_back({scene, view, scene->lights, scene->ambient, scene->environment, of_file});
    add_distinct(views.back().warnings, collector.warnings());
  }
  return views;
}

}  // namespace lightgrid
