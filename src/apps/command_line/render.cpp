// lightgrid render SCENE -t TECHNIQUE -o out.png|out.exr
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/timer.h"
#include "command_line/commands.h"
#include "command_line/look.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "measures/path_changes.h"
#include "measures/words.h"
#include "plan/plan_changes.h"
#include "run/technique_run.h"

namespace lightgrid::app {
using namespace lab;
namespace {

constexpr int exr_encoder_bytes = 72;  // per pixel that does not compress: planes, blocks and the file

struct RenderOptions {
  SceneChoice scene;
  DeviceOptions devices;
  TimingOptions timing{.frames = 1, .warmup = 0};
  LookOptions look;
  std::string technique, output = "out.png", json;
};

// out.png becomes out_0000.png, out_0001.png and so on.
std::filesystem::path numbered(const std::filesystem::path& path, size_t number) {
  std::filesystem::path numbered = path;
  return numbered.replace_filename(
      fmt::format("{}_{:04}{}", path.stem().string(), number, path.extension().string()));
}

int render_path(const RenderOptions& o, TechniqueRun& run, GpuScene& gpu, const std::vector<View>& path,
                const SceneMotion& advance) {
  run.prepare();
  PathPlans plans;
  Exposure exposure;  // the first picture's, for all
  for (size_t i = 0; i < path.size(); ++i) {
    const SceneChanges changes = advance ? advance(i) : SceneChanges();
    gpu.update(changes);
    run.look(path[i], changes);
    run.run_frame();
    plans.add(run.view().plan);
    if (i == 0) tell_exposure(exposure = exposure_of_look(o.look, o.scene, run.image()));
    save_displayed(numbered(o.output, i), run.image(), chosen_display(o.look, exposure));
  }
  if (!o.json.empty()) {
    run.run_profiled_frames();
    nlohmann::json json = to_json(RunResult{run.result()});
    json["exposure"] = exposure_json(exposure);
    json["moving"] = {{"frames", path.size()}, {"plan_changes", plan_changes_json(plans.changes())}};
    write_json(o.json, json_text(json));
  }
  return 0;
}

int render(RenderOptions o) {
  take_own_settings(o.technique, o.scene.set);  // reports an unknown name before the scene is loaded
  if (o.look.look && o.technique.empty())
    o.technique = "visibility";  // it draws shadows with several samples
  if (!o.technique.empty()) choose_look(o.look, {&find_technique(o.technique)}, o.scene);
  const Settings settings = chosen_settings(o.scene);
  if (!o.technique.empty()) check_given_settings(settings, {{&find_technique(o.technique), settings}});
  check_image_path(o.output);
  check_output_file("-o", o.output);
  if (!o.json.empty()) check_output_file("--json", o.json);
  parse_gl_backend(o.devices.gl);
  o.scene.device = o.devices.device;
  ChosenScene chosen = load_chosen_scene(o.scene);
  const std::vector<View> path = chosen_path(chosen.scene, chosen.view, o.scene);
  Renderer renderer = open_devices(o.devices, o.technique, settings);
  const Technique& technique = technique_or_default(o.technique, renderer);
  check_given_settings(settings, {{&technique, settings}},
                       {.casts = std::ranges::any_of(chosen.scene.lights, &Light::casts_shadow)});
  const SceneMotion advance = chosen_motion(chosen.scene, o.scene);
  if (path.empty() && o.scene.light_motion != "none") advance(0);
  GpuScene gpu(renderer, chosen.scene);
  const int file_bytes = std::filesystem::path(o.output).extension() == ".exr" ? exr_encoder_bytes : 0;
  TechniqueRun run(renderer, gpu, chosen.view, settings, technique, nullptr, file_bytes);
  if (!path.empty()) return render_path(o, run, gpu, path, advance);
  for (int i = 0; i < o.timing.warmup; ++i) run.run_frame(true);
  for (int i = 0; i < o.timing.frames; ++i) run.run_frame();
  const Exposure exposure = exposure_of_look(o.look, o.scene, run.image());
  tell_exposure(exposure);
  run.release();  // for the file's encoder
  save_displayed(o.output, run.image(), chosen_display(o.look, exposure));
  if (o.timing.frames > 1) {
    const double ms = spread_of(run.frame_ms()).median;
    log_info("a frame takes {} ms: {} frames a second (median of {})", short_number(ms),
             short_number(1000 / ms), o.timing.frames);
    if (o.technique.empty() && renderer.gl && renderer.gl->software)
      log_info("{} draws with OpenGL in software here; -t visibility draws in OpenCL alone, mostly faster",
               technique.name);
  }
  if (!o.json.empty()) {
    for (int i = 0; i < std::max(1, o.timing.warmup); ++i) run.run_frame(true);  // release() dropped caches
    run.run_profiled_frames();
    nlohmann::json json = to_json(RunResult{run.result()});
    json["exposure"] = exposure_json(exposure);
    write_json(o.json, json_text(json));
  }
  return 0;
}

}  // namespace

void add_render(CommandLine& line) {
  auto o = std::make_shared<RenderOptions>();
  Subcommand command = line.add("render", "one image of a scene", [o] { return render(*o); });
  add_scene_options(command, o->scene);
  add_path_option(command, o->scene);
  add_exposure_option(command, o->scene);
  add_look_options(command, o->look);
  add_device_options(command, o->devices);
  add_timing_options(command, o->timing);
  add_technique_option(command, o->technique, technique_names());
  command.option("-o,--output", o->output,
                 "image file, .png or .exr; with a camera path NAME_0000.png and so on");
  command.option("--json", o->json, "results as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
