// What certificates of shadows save, on the OpenCL device that lightgrid would use: the technique visibility
// with all lights of a scene casting, the pass find_shadows with and without them frame by frame in turn.
// Where the camera turns, pieces come into view all the time. Says whether both found the same bits.
//   kept_cost SCENE.gltf|hall|street|... [LIGHTS.json [NUMBER]]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

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

struct Cost {
  double pass_ms, frame_cpu_ms;  // find_shadows; all threads, all passes
};

double cpu_ms() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

Cost cost_of_frame(TechniqueRun& run) {
  run.view().timer.enabled = true;
  const double before = cpu_ms();
  run.draw_frame();
  const double after = cpu_ms();
  double ms = 0;
  for (const PassRecord& pass : run.view().timer.records())
    if (pass.name == "find_shadows") ms = pass.ms.back();
  run.view().timer.enabled = false;
  return {ms, after - before};
}

struct Contestant {
  std::string name;
  std::unique_ptr<TechniqueRun> run;
  std::vector<double> ms{}, cpu{};
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
  const auto median = [](std::vector<double>& v) {
    std::ranges::sort(v);
    return v[v.size() / 2];
  };
  // At rest everything of the last contestant's frame is other passes' time.
  double other = 0;
  const auto table = [&](const std::string& title) {
    fmt::print("{}\n", title);
    if (other == 0) other = median(all.back().cpu);
    const double base = median(all[0].ms), cpu = median(all[0].cpu) - other;
    for (Contestant& c : all) {
      const ShadowFigures f = c.run->frame().shadow_figures();
      const double ms = median(c.ms), own = median(c.cpu) - other;
      fmt::print(
          "  {:>5}: first {:6.1f}, least {:6.1f}, median {:6.1f} ms ({:.2f}), CPU time {:6.1f} ms ({:.2f}); "
          "{} rays, {} pairs kept, {:.1f} MB\n",
          c.name, c.first, c.ms.front(), ms, ms / base, own, own / cpu, f.rays, f.certified,
          double(f.bytes) / 1e6);
      c.ms.clear(), c.cpu.clear();
    }
  };
  const auto frame_of = [&](Contestant& c, const View& from) {
    c.run->look(from);
    const Cost cost = cost_of_frame(*c.run);
    c.ms.push_back(cost.pass_ms), c.cpu.push_back(cost.frame_cpu_ms);
  };
  for (Contestant& c : all) c.run->prepare();
  for (int frame = 0; frame < 13; ++frame) {
    for (Contestant& c : all) {
      frame_of(c, view);
      if (frame == 0) c.first = c.ms.back(), c.ms.clear(), c.cpu.clear();
    }
    if (frame % 6 == 0) same_bits();
  }
  table(fmt::format("{} {} x {}, {}, {} lights, camera at rest", name, width, height,
                    renderer.cl->info().name, scene.lights.size()));
  const std::vector<View> turn = camera_path(scene, view, "turn:180");
  const auto along = [&](const std::string& title, size_t frames, const auto& view_of) {
    for (size_t frame = 0; frame < frames; ++frame) {
      for (Contestant& c : all) frame_of(c, view_of(frame));
      if (frame % 10 == 9) same_bits();
    }
    table(title);
  };
  // Every piece has its certificates, and no tile shows what it did.
  along("two views in turn, 2 degrees apart", 20, [&](size_t frame) { return turn[frame % 2]; });
  along("turned by 2 degrees a frame", 40, [&](size_t frame) { return turn[frame]; });
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
