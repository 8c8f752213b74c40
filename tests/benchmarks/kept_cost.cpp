// What certificates of shadows save, on the OpenCL device that lightgrid would use: the technique visibility
// with all lights of a scene casting, the pass find_shadows with and without them frame by frame in turn.
// Where the camera turns, pieces come into view all the time. Says whether both found the same bits.
//   kept_cost SCENE.gltf|hall|street|... [LIGHTS.json [NUMBER]]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/timer.h"
#include "scene/builtin.h"
#include "scene/camera_path.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "session/technique_run.h"

namespace lightgrid {
namespace {

constexpr int width = 1280, height = 720;

double pass_ms(TechniqueRun& run) {
  run.view().timer.enabled = true;
  run.draw_frame();
  double ms = 0;
  for (const PassRecord& pass : run.view().timer.records())
    if (pass.name == "find_shadows") ms = pass.ms.back();
  run.view().timer.enabled = false;
  return ms;
}

struct Contestant {
  std::string name;
  std::unique_ptr<TechniqueRun> run;
  std::vector<double> ms{};
  double first = 0;
};

void measure(const std::string& name, const char* lights_file, size_t most_lights,
             const std::vector<std::string>& sizes) {
  const BuiltinScene* builtin = find_builtin_scene(name);
  Scene scene = builtin ? builtin->make() : load_gltf(name);
  if (lights_file) scene.lights = load_lights_file(lights_file);
  if (scene.lights.size() > most_lights) scene.lights.resize(most_lights);
  for (Light& light : scene.lights) light.casts_shadow = true;
  Renderer renderer("", GlBackend::none);
  GpuScene gpu(renderer, scene);
  const View view = make_view(choose_camera(scene, "", double(width) / height), width, height);
  std::vector<Contestant> all;
  for (const std::string& size : sizes) {
    Settings settings;
    apply_setting(settings, "shadow-kept=" + size);
    all.push_back(
        {size, std::make_unique<TechniqueRun>(renderer, gpu, view, settings, find_technique("visibility"))});
  }
  const auto same_bits = [&] {
    const HostShadows truth = all[0].run->frame().shadows();
    for (const Contestant& c : all)
      if (c.run->frame().shadows().bits != truth.bits) fmt::print("DIFFERENT: shadow-kept={}\n", c.name);
  };
  const auto table = [&](const char* title) {
    fmt::print("{}\n", title);
    std::ranges::sort(all[0].ms);
    const double base = all[0].ms[all[0].ms.size() / 2];
    for (Contestant& c : all) {
      std::ranges::sort(c.ms);
      const ShadowFigures f = c.run->frame().shadow_figures();
      const double median = c.ms[c.ms.size() / 2];
      fmt::print(
          "  {:>5}: first {:7.1f} ms, least {:7.1f}, median {:7.1f} ({:.2f}); {} rays, {} pairs kept, {:.1f} "
          "MB\n",
          c.name, c.first, c.ms.front(), median, median / base, f.rays, f.certified, double(f.bytes) / 1e6);
      c.ms.clear();
    }
  };
  for (Contestant& c : all) c.run->prepare();
  for (int frame = 0; frame < 12; ++frame) {
    for (Contestant& c : all) {
      c.run->look(view);
      const double ms = pass_ms(*c.run);
      frame == 0 ? void(c.first = ms) : c.ms.push_back(ms);
    }
    if (frame % 6 == 0) same_bits();
  }
  table(fmt::format("{} {} x {}, {}, {} lights, camera at rest", name, width, height,
                    renderer.cl->info().name, scene.lights.size())
            .c_str());
  const std::vector<View> turn = camera_path(scene, view, "turn:180");
  for (size_t frame = 0; frame < 20; ++frame) {
    for (Contestant& c : all) {
      c.run->look(turn[frame]);
      c.ms.push_back(pass_ms(*c.run));
    }
    if (frame % 10 == 9) same_bits();
  }
  table("turned by 2 degrees a frame");
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  try {
    if (count < 2)
      throw lightgrid::input_error("kept_cost SCENE.gltf|hall|street|... [LIGHTS.json [NUMBER]]");
    lightgrid::measure(arguments[1], count > 2 ? arguments[2] : nullptr,
                       count > 3 ? size_t(std::stoul(arguments[3])) : size_t(-1), {"off", "64M"});
  } catch (const lightgrid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
