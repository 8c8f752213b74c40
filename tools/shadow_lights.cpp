// How the time of a frame of the technique visibility grows with the number of lights, all of which cast:
// with exact shadows, shadow maps, and none. Frames of the
// settings run in turn. A CSV line for each scene, size, number of lights and setting, as shadow_lights.py
// reads it (docs/results/shadows.md).
//   shadow_lights [--device NAME] [--seconds N] [SCENE.gltf LIGHTS.json]…     about N seconds, 240 by default
// Lights of built-in scenes are scattered, of one radius, so that twice the lights make twice the pairs of a
// pixel and a light; those of a file are its first ones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/text.h"
#include "base/timer.h"
#include "base/version.h"
#include "run/scene_choice.h"
#include "run/technique_run.h"

namespace lightgrid {
namespace {

constexpr const char* settings[] = {"shadows=none", "shadows=exact", "shadows=map shadow-size=64",
                                    "shadows=map shadow-size=256"};
constexpr const char* exact = settings[1];

// From a longest frame on, more lights are not measured; the frames of a setting are as many as fit into its
// share of the time, at least three.
constexpr double longest_ms = 250;
constexpr int min_frames = 3, max_frames = 25;

struct SettingRun {
  std::string name;
  std::unique_ptr<TechniqueRun> run;
};

double kernel_ms(const PassRecord& pass, const std::string& name) {
  std::vector<double> all;
  for (const std::vector<KernelTime>& frame : pass.kernels) {
    double ms = 0;
    for (const KernelTime& kernel : frame)
      if (name.empty() || kernel.name.find(name) != std::string::npos) ms += kernel.ms;
    all.push_back(ms);
  }
  return all.empty() ? 0 : spread_of(all).median;
}

// The median range of the scene's own lights, in metres, to a decimal.
double median_radius(const std::vector<Light>& lights) {
  std::vector<double> radii;
  for (const Light& light : lights)
    if (std::isfinite(light.radius_m)) radii.push_back(light.radius_m);
  return radii.empty() ? 1 : std::round(10 * spread_of(radii).median) / 10;
}

void print_row(const SettingRun& s, const Scene& scene, const View& view, const ClDeviceInfo& device,
               size_t pairs) {
  const std::vector<PassRecord>& passes = s.run->view().timer.records();
  double kernels = 0, found = 0, drawn = 0;
  for (const PassRecord& pass : passes) {
    kernels += kernel_ms(pass, "");
    if (pass.name == "find_shadows") {
      found = kernel_ms(pass, "find_shadows");
      drawn = kernel_ms(pass, "draw_faces");
    }
  }
  const Frame& frame = s.run->frame();
  const ShadowFigures f = frame.shadow_figures ? frame.shadow_figures() : ShadowFigures{};
  const Spread ms = spread_of(s.run->frame_ms());
  fmt::print("{},\"{}\",{},{}x{},{},{:g},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{},{}\n",
             commit_of_build(), device.name, scene.name, view.width, view.height, scene.lights.size(),
             median_radius(scene.lights), s.name, s.run->frame_ms().size(), ms.min, ms.median, kernels, found,
             drawn, pairs, f.lights, f.rays, f.maps, f.drawn, f.kept, f.bytes);
  std::fflush(stdout);
}

// Returns the settings whose frames took longer than is worth waiting for.
std::vector<std::string> measure_lights(Renderer& renderer, const SceneChoice& choice, double seconds,
                                        const std::vector<std::string>& left_out) {
  const ChosenScene chosen = load_chosen_scene(choice);
  GpuScene gpu(renderer, chosen.scene);
  const auto pool = std::make_shared<TargetPool>();
  std::vector<SettingRun> runs;
  const Timer timer;
  for (const char* name : settings) {
    if (std::ranges::find(left_out, name) != left_out.end()) continue;
    Settings s;
    std::string rest = name;
    for (size_t end; !rest.empty(); rest.erase(0, end == std::string::npos ? end : end + 1)) {
      end = rest.find(' ');
      apply_setting(s, rest.substr(0, end));
    }
    runs.push_back({name, std::make_unique<TechniqueRun>(renderer, gpu, chosen.view, s,
                                                         find_technique("visibility"), pool)});
  }
  for (SettingRun& r : runs) {
    for (int frame = 0; frame < 2; ++frame)
      r.run->run_frame(true);  // compile, take memory, keep what they find
  }
  const double begun = timer.elapsed_ms();
  for (int frame = 0; frame < max_frames; ++frame) {
    for (SettingRun& r : runs) r.run->run_frame();
    const double took = timer.elapsed_ms() - begun;
    if (frame + 1 >= min_frames && timer.elapsed_ms() + took / (frame + 1) > 0.8 * seconds * 1000) break;
  }
  std::vector<std::string> too_long;
  size_t pairs = 0;
  for (SettingRun& r : runs) {
    r.run->run_profiled_frames(200);
    if (r.name == exact) pairs = r.run->frame().shadow_figures ? r.run->frame().shadow_figures().rays : 0;
  }
  for (SettingRun& r : runs) {
    print_row(r, chosen.scene, chosen.view, renderer.cl->info(), pairs);
    if (spread_of(r.run->frame_ms()).median > longest_ms) too_long.push_back(r.name);
  }
  return too_long;
}

void measure(const std::string& device, double seconds, const std::vector<std::string>& files) {
  std::vector<SceneChoice> choices;
  for (const char* scene : {"hall", "street", "gallery", "terrain"}) {
    const double radius = median_radius(load_scene({.scene = scene}).lights);
    choices.emplace_back();
    choices.back().scene = scene;
    choices.back().light_radius = fmt::format("{0:g},{0:g}", radius);
  }
  for (size_t i = 0; i + 1 < files.size(); i += 2) {
    choices.emplace_back();
    choices.back().scene = files[i];
    choices.back().lights_file = files[i + 1];
  }
  Renderer renderer(device, GlBackend::none);
  fmt::print(
      "commit,device,scene,size,lights,radius_m,shadows,frames,least_ms,frame_ms,kernels_ms,"
      "find_shadows_ms,draw_maps_ms,pairs,lights_found,rays,maps,maps_drawn,maps_kept,bytes\n");
  const std::vector<int> series = {4, 16, 64, 256, 1024, 4096};
  const std::vector<std::pair<const char*, std::vector<int>>> sizes = {
      {"640x360", series}, {"1280x720", series}, {"3840x2160", {64}}};
  const Timer timer;
  size_t steps = 0, done = 0;
  for (const auto& [size, lights] : sizes) steps += lights.size() * choices.size();
  for (SceneChoice& choice : choices) {
    choice.shadows = "all";
    for (const auto& [size, lights] : sizes) {
      std::vector<std::string> left_out;
      choice.size = size;
      for (const int count : lights) {
        ++done;
        if (left_out.size() == std::size(settings)) continue;
        choice.lights = count;
        const double left = seconds - timer.elapsed_ms() / 1000;
        try {
          for (std::string& name :
               measure_lights(renderer, choice, std::max(left, 0.0) / double(steps - done + 1), left_out))
            left_out.push_back(std::move(name));
        } catch (const Error& error) {  // a file of fewer lights
          std::fprintf(stderr, "%s\n", error.what());
          break;
        }
      }
    }
  }
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  using namespace lightgrid;
  try {
    std::string device;
    double seconds = 240;
    std::vector<std::string> files;
    for (int i = 1; i < count; ++i) {
      if (!std::strcmp(arguments[i], "--device") && i + 1 < count) {
        device = arguments[++i];
      } else if (!std::strcmp(arguments[i], "--seconds") && i + 1 < count) {
        seconds = parse_number<double>(arguments[++i]).value_or(0);
      } else {
        files.emplace_back(arguments[i]);
      }
    }
    if (files.size() % 2 != 0 || !(seconds > 0))
      throw input_error("shadow_lights [--device NAME] [--seconds N] [SCENE.gltf LIGHTS.json]…");
    measure(device, seconds, files);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
