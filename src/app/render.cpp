// lightgrid render SCENE -t TECHNIQUE -o out.png|out.exr
#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "base/error.h"
#include "study/run_technique.h"

namespace lightgrid {
namespace {

struct RenderOptions {
  SceneOptions scene;
  DeviceOptions devices;
  TimingOptions timing{.frames = 1, .warmup = 0};
  std::string technique = "forward_plus", output = "out.png", json;
};

int render(const RenderOptions& o) {
  const Technique& technique = find_technique(o.technique);
  const Settings settings = chosen_settings(o.scene);
  check_image_path(o.output);
  check_output_file("-o", o.output);
  if (!o.json.empty()) check_output_file("--json", o.json);
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  const ChosenScene chosen = load_chosen_scene(o.scene);
  Renderer devices(o.devices.device, backend);
  TechniqueRun run(devices, chosen.scene, chosen.view, settings, technique);
  for (int i = 0; i < o.timing.warmup; ++i) run.run_frame(true);
  for (int i = 0; i < o.timing.frames; ++i) run.run_frame();
  save_image(o.output, run.image());
  if (!o.json.empty()) {
    run.run_profiled_frames();
    write_json(o.json, json_text(run.result()));
  }
  return 0;
}

}  // namespace

void add_render(CommandLine& line) {
  auto o = std::make_shared<RenderOptions>();
  Subcommand command = line.add("render", "one image of a scene", [o] { return render(*o); });
  add_scene_options(command, o->scene);
  add_device_options(command, o->devices);
  add_timing_options(command, o->timing);
  command.option("-t,--technique", o->technique, technique_names());
  command.option("-o,--output", o->output, "image file, .png or .exr");
  command.option("--json", o->json, "results as JSON into a file, - for stdout");
}

}  // namespace lightgrid
