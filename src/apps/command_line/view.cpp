// lightgrid view SCENE: a window. Reports an error if the build found no GLFW or no Dear ImGui.
#include <memory>

#include "base/error.h"
#include "command_line/commands.h"
#include "command_line/look.h"
#include "command_line/options.h"
#include "scenes/builtin.h"
#include "techniques/technique.h"
#ifdef LIGHTGRID_VIEW
#include "view/controls.h"
#include "view/viewer.h"
#endif

namespace lightgrid::app {
using namespace lab;
namespace {

struct ViewOptions {
  SceneChoice scene;
  std::string device, left, right, script, screenshot;
  int frames = 0;  // 0: not given
  LookOptions look;
};

#ifdef LIGHTGRID_VIEW

// The options that select the scene and its lights, for `lightgrid render`.
std::string scene_words(const ViewOptions& o) {
  const SceneChoice& s = o.scene;
  std::string words = shell_word(s.scene);
  if (s.lights >= 0) words += fmt::format(" --lights {}", s.lights);
  if (!s.lights_file.empty()) words += " --lights-file " + shell_word(s.lights_file);
  if (!s.light_radius.empty()) words += " --light-radius " + shell_word(s.light_radius);
  if (s.virtual_lights > 0) words += fmt::format(" --virtual-lights {}", s.virtual_lights);
  if (!s.virtual_from.empty()) words += " --virtual-from " + s.virtual_from;
  if (!s.virtual_nearest.empty()) words += " --virtual-nearest " + s.virtual_nearest;
  if (!s.ambient.empty()) words += " --ambient " + shell_word(s.ambient);
  if (!s.environment.empty()) words += " --environment " + shell_word(s.environment);
  if (((s.lights >= 0 && s.lights_file.empty()) || s.virtual_lights > 0) && s.seed != SceneChoice().seed)
    words += fmt::format(" --seed {}", s.seed);
  if (!s.exposure.empty()) words += " --exposure " + s.exposure;
  if (o.look.look) words += " --look";
  if (!o.look.curve.empty()) words += " --curve " + o.look.curve;
  if (!o.look.glow.empty()) words += " --glow " + o.look.glow;
  if (!o.device.empty()) words += " --device " + shell_word(o.device);
  return words;
}

// Without the scene.
ViewJob make_job(const ViewOptions& o) {
  ViewJob job;
  job.name = o.scene.scene;
  for (const BuiltinScene& scene : builtin_scenes()) job.scenes.push_back(scene.name);
  if (!find_builtin_scene(job.name)) job.scenes.push_back(job.name);
  job.controls.lights = light_motion(o.scene.light_motion);
  chosen_casters(o.scene.shadows);  // reports a fault before the scene is loaded
  job.controls.casters = o.scene.shadows;
  job.scripted = !o.script.empty() || !o.screenshot.empty();
  if (o.frames > 0 && !job.scripted)
    throw input_error("view: --frames: ends a --script or --screenshot; a window ends when it is closed");
  job.frames = o.frames > 0 ? o.frames : 60;
  job.screenshot = o.screenshot;
  if (job.scripted) job.controls.rate = 0;
  if (!o.script.empty()) job.script = Script::read(o.script);
  if (!o.screenshot.empty()) check_output_file("--screenshot", o.screenshot);
  job.seconds = chosen_time(o.scene);
  job.scene_words = scene_words(o);
  job.camera = o.scene.camera;
  const Display display = chosen_display(o.look);
  job.filmic = display.curve == DisplayCurve::filmic;
  job.glow = display.glow;
  job.expose = [o](const Image& image) { return exposure_of_look(o.look, o.scene, image); };
  return job;
}

// The window chooses the lights that cast, so that the scene's own can be chosen again.
void load(ViewJob& job, SceneChoice choice) {
  choice.shadows.clear();
  job.reflect = [choice](Scene& scene) { return chosen_virtual_lights(scene, choice); };
  ChosenScene chosen = load_chosen_scene(choice);
  job.scene = std::move(chosen.scene);
  job.view = chosen.view;
}

// The options of the first scene only are left out: its camera, its file of lights, its time.
ViewJob load_other(ViewOptions o, const std::string& scene) {
  o.scene.scene = scene;
  o.scene.camera = o.scene.lights_file = o.scene.time = "";
  o.scene.device = o.device;
  ViewJob job = make_job(o);
  SceneChoice choice = o.scene;
  choice.device = o.device;
  load(job, choice);
  job.load = [o](const std::string& name) { return load_other(o, name); };
  return job;
}

int view(ViewOptions o) {
  for (const std::string& technique : {o.left, o.right}) {
    if (!technique.empty()) find_technique(technique);
  }
  chosen_settings(o.scene);  // reports a fault before the window is opened
  ViewJob job = make_job(o);
  const ImageSize size = parse_size(o.scene.size);
  Window window(size.width + panel_width, size.height, "lightgrid: " + o.scene.scene, !job.scripted);
  std::unique_ptr<GlContext> context = window.make_context();
  Interface interface(window, job.scripted);
  interface.announce("loading " + o.scene.scene);
  // Where OpenGL is in software, forward_plus takes many times as long.
  const char* beside = context->software ? "visibility" : "forward_plus";
  choose_look(o.look,
              {&find_technique(o.left.empty() ? "visibility" : o.left),
               &find_technique(o.right.empty() ? beside : o.right)},
              o.scene);
  job.controls.casters = o.scene.shadows;
  const Settings settings = chosen_settings(o.scene);
  job.controls.sides = {{{o.left.empty() ? "visibility" : find_technique(o.left).name, settings},
                         {o.right.empty() ? beside : find_technique(o.right).name, settings}}};
  const auto& [left, right] = job.controls.sides;
  const bool chosen = !o.left.empty() && !o.right.empty();
  if (left.technique == right.technique && !chosen && !job.scripted)
    job.controls.sides[1].map = SideMap::listed;
  SceneChoice choice = o.scene;
  choice.device = o.device;
  load(job, choice);
  job.load = [o](const std::string& name) { return load_other(o, name); };
  Renderer renderer(o.device, std::move(context));
  for (std::optional<ViewJob> next = std::move(job); next;) {
    window.set_title("lightgrid: " + next->name);
    next = Viewer(window, interface, renderer, std::move(*next)).run();
  }
  return 0;
}

#else

int view(ViewOptions) {
  throw machine_error(
      "view: built without a window; with Debian's libglfw3-dev and libimgui-dev installed, configure and "
      "build again");
}

#endif

}  // namespace

void add_view(CommandLine& line) {
  auto o = std::make_shared<ViewOptions>();
  Subcommand command = line.add("view", "a window: fly through a scene, two techniques side by side",
                                [o] { return view(*o); });
  add_scene_options(command, o->scene);
  add_exposure_option(command, o->scene);
  add_look_options(command, o->look);
  command.option("--light-motion", o->scene.light_motion, "lights that move: none, orbit or drift");
  command.option("--device", o->device, "OpenCL device, by a part of its name");
  command.option("--left", o->left, "technique of the left side (visibility)");
  command.option("--right", o->right,
                 "technique of the right side (forward_plus; visibility where OpenGL is in software)");
  command.option("--script", o->script, "a file of input to replay");
  command.option("--frames", o->frames, "frames of a script, after which the program ends", 1, 1'000'000);
  command.option("--screenshot", o->screenshot, "the last frame of a script as a PNG");
}

}  // namespace lightgrid::app
