// The scene, lights, camera, settings and devices of a run, chosen by text, for the command line, the window
// and other front ends. Error(input) names the field and its value.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/log.h"
#include "plan/settings.h"
#include "run/virtual_lights.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "scene/scene_motion.h"
#include "techniques/technique.h"

namespace lightgrid {

struct GltfLimits;  // scene/load_gltf.h

inline constexpr int max_lights = 10'000'000, max_virtual_lights = 1'000'000;

// Fields as in docs/command_line.md.
struct SceneChoice {
  std::string scene = "hall";
  std::string size = "1280x720";
  std::string camera;
  std::string camera_path;  // empty: a camera at rest
  std::string time;         // seconds; empty: at rest
  std::string light_motion = "none";
  int lights = -1;    // -1: the scene's own
  int ranges_of = 0;  // scattered lights have the ranges of this many; 0: of `lights`
  std::string lights_file;
  std::string light_radius;
  std::string ambient;          // radiance from all sides; empty: the scene's own
  std::string environment;      // light from surroundings (scene/environment_light.h); empty: the scene's own
  std::string shadows;          // lights that cast: a number, all or none; empty: those that the scene says
  int virtual_lights = 0;       // run/virtual_lights.h
  std::string virtual_from;     // lights that are reflected: a number, or all; empty: all
  std::string virtual_nearest;  // metres, or auto; empty: auto
  std::string device;           // that places virtual lights: DeviceOptions::device
  uint64_t seed = 1;
  std::string brdf;  // empty: ggx, or from --set
  std::vector<std::string> set;
  std::string files;  // that a glTF file may name: below its folder, or anywhere; empty: below
  std::string
      image_memory;      // that its decoded images may take: bytes, or with K, M or G; empty: by the machine
  int texture_size = 0;  // larger images are averaged down to this side; 0: to the largest that is drawn
  std::string exposure;  // exposure of pictures: stops, or auto; empty: auto for files, 0 for built-in scenes
};

// The fields by their names, which command lines have as options and messages as their first word.
struct ChoiceField {
  enum class Of { scene, file, view, picture, path };  // which commands have it as an option
  const char* name;
  const char* help;
  Of of;
  std::variant<std::string SceneChoice::*, int SceneChoice::*, uint64_t SceneChoice::*> value;
  int most = 0;  // largest value of an int; least is 0
};
const std::vector<ChoiceField>& choice_fields();

// Sets one from "NAME=VALUE". Throws Error(input) that lists the names. Values of text are checked when they
// are used.
void set_choice_field(SceneChoice& choice, const std::string& assignment);

// The property that stays the same over a series of numbers of scattered lights: their ranges, or how many of
// them reach a point, for which ranges shrink as the number grows.
enum class Kept { range, overlap };
// Throws Error(input) for another word, and for overlap where ranges cannot follow the number: those of
// light-radius or of a lights-file.
Kept parse_kept(const std::string& keep, const SceneChoice& choice);
const char* name_of(Kept kept);

struct DeviceOptions {
  std::string device;
  std::string gl = "auto";
};

struct TimingOptions {
  int frames = 5;
  int warmup = 1;
};

struct ImageSize {
  int width = 0, height = 0;
};
ImageSize parse_size(const std::string& text);
Scene load_scene(const SceneChoice& choice);
// Throws for a fault in a field that can be found without the scene.
void check_choice(const SceneChoice& choice);
GltfLimits chosen_limits(const SceneChoice& choice);
// Seconds into the animations of the file; empty: at rest.
std::optional<double> chosen_time(const SceneChoice& choice);
// The view of a loaded scene; replaces its lights and ambient light by those of the choice.
View choose_view(Scene& scene, const SceneChoice& choice);
// The scene's motion along a path, 30 frames a second from the chosen time; empty if nothing moves. The scene
// outlives it.
SceneMotion chosen_motion(Scene& scene, const SceneChoice& choice);
// The views of the camera path; empty without one.
std::vector<View> chosen_path(const Scene& scene, const View& start, const SceneChoice& choice);
struct ChosenScene {
  Scene scene;
  View view;
};
ChosenScene load_chosen_scene(const SceneChoice& choice);
Settings chosen_settings(const SceneChoice& choice);
// Null: none are chosen. The scene outlives it.
std::unique_ptr<VirtualLights> chosen_virtual_lights(Scene& scene, const SceneChoice& choice);
// How many lights cast, by SceneChoice::shadows; empty: those that the scene says.
std::optional<size_t> chosen_casters(const std::string& shadows);
// The exposure of a run's pictures; auto takes it from `image`, or 0 if that has no pixels.
Exposure chosen_exposure(const SceneChoice& choice, const Image& image);
// Logs an exposure that was chosen here and is not 0. `view` begins the line.
void tell_exposure(const Exposure& exposure, const std::string& view = "");

// The devices for a technique by its name, with these settings; empty: whichever can be had. OpenGL is opened
// only if the technique needs it or `gl` names a backend. Throws Error(input) for an unknown name,
// Error(machine) without what it needs.
Renderer open_devices(const DeviceOptions& options, const std::string& technique, const Settings& settings);

// The technique by its name; if that is empty, forward_plus or, without OpenGL, visibility, which is reported
// in the log.
const Technique& technique_or_default(const std::string& technique, const Renderer& renderer);

// A view and its lights; several views may share the scene.
struct LoadedView {
  std::shared_ptr<Scene> scene;
  View view;
  std::vector<Light> lights;
  glm::vec3 ambient;
  std::shared_ptr<const Environment> environment;
  std::vector<Warning> warnings;  // warnings of the file, the lights and the camera

  // The scene with this view's lights.
  Scene& with_lights() const {
    scene->lights = lights;
    scene->ambient = ambient;
    scene->environment = environment;
    return *scene;
  }
};

// Neighbouring choices with the same scene share it. An error in any of them is thrown before the first view
// is run.
std::vector<LoadedView> load_views(const std::vector<SceneChoice>& choices);

}  // namespace lightgrid
