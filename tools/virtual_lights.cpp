// Virtual lights by count and clamp: error against the truth of one bounce, and time against a frame without
// them, as CSV. Needs Embree. docs/fake_radiosity.md has the tables.
//   virtual_lights errors|times SCENE LIGHTS_FILE CAMERA [BRDF]
#include <fmt/format.h>

#include "base/timer.h"
#include "compare/contestants.h"
#include "plan/settings/model.h"
#include "run/scene_choice.h"
#include "support/virtual_light_error.h"

namespace lightgrid {
using namespace lab;
namespace {

#ifdef LIGHTGRID_EMBREE

constexpr std::array counts = {64, 256, 1024, 4096};

ChosenScene load(const std::string& size, const char* const* arguments) {
  SceneChoice choice;
  choice.scene = arguments[0];
  choice.lights_file = arguments[1];
  choice.camera = arguments[2];
  choice.size = size;
  ChosenScene chosen = load_chosen_scene(choice);
  // Truth and picture leave blended surfaces out.
  std::erase_if(chosen.scene.instances, [&](const Instance& i) {
    const Mesh& mesh = chosen.scene.meshes[size_t(i.mesh)];
    return chosen.scene.materials[size_t(mesh.material)].alpha_mode == AlphaMode::blend;
  });
  return chosen;
}

void tell_errors(Renderer& renderer, const char* const* arguments, const Settings& settings) {
  const ChosenScene chosen = load("160x90", arguments);
  OneBounceView seen(renderer, chosen.scene, chosen.view, settings, 1500, 1024);
  fmt::print("truth: mean {:.4g}, noise of a pixel {:.3g} of it\n", seen.truth_mean(), seen.truth_noise());
  fmt::print("count,nearest,shadows,cutoff,bias,mean_abs,rms,spread\n");
  const auto tell = [&](int count, double nearest, bool shadows, const char* cutoff) {
    Settings s = settings;
    if (cutoff) {
      apply_setting(s, "range=cutoff");
      apply_setting(s, std::string("cutoff=") + cutoff);
    }
    seen.set_ranges(s.ranges);
    const VirtualLightError e = seen.error({.count = count, .nearest_m = nearest}, shadows, 4);
    fmt::print("{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}\n", count,
               nearest < 0 ? "auto" : fmt::format("{:g}", nearest), shadows ? "exact" : "none",
               cutoff ? cutoff : "", e.bias, e.mean_abs, e.rms, e.spread);
    std::fflush(stdout);
  };
  for (const int count : counts) {
    for (const double nearest : {0.0, 0.25, 1.0, -1.0}) tell(count, nearest, true, nullptr);
    tell(count, -1, false, nullptr);
  }
  for (const char* technique : {"forward_plus", "lidr"}) {  // lidr: with room for 8 lights a pixel
    seen.set_technique(technique);
    fmt::print("{}: ", technique);
    tell(1024, -1, false, nullptr);
  }
  seen.set_technique("visibility");
  for (const char* cutoff : {"0.02", "0.005", "0.001", "0.0002"}) tell(1024, -1, true, cutoff);
}

// Frames of all counts in turn, over those without virtual lights. The cutoff falls with the lights' flux, so
// that their ranges do not depend on the count.
void tell_times(Renderer& renderer, const char* const* arguments, const Settings& given) {
  fmt::print("technique,range,count,frame over none,placing over a frame of none\n");
  for (const char* range : {"range=scene", "range=cutoff"}) {
    for (const char* technique : {"forward_plus", "visibility", "lidr"}) {
      std::vector<std::unique_ptr<Scene>> scenes;
      std::vector<std::unique_ptr<TechniqueRun>> runs;
      std::vector<double> placing;
      const ChosenScene chosen = load("640x360", arguments);
      for (const int count : {0, 64, 256, 1024, 4096}) {
        Settings settings = given;
        apply_setting(settings, range);
        apply_setting(settings, fmt::format("cutoff={:g}", 0.2 / std::max(count, 64)));
        scenes.push_back(std::make_unique<Scene>(chosen.scene));
        Scene& scene = *scenes.back();
        for (Light& light : scene.lights) light.casts_shadow = false;
        VirtualLights placed(scene, renderer.cl->info().name, settings, {.count = count});
        placed.place();
        const Timer timer;
        placed.place();
        placing.push_back(timer.elapsed_ms());
        try {
          runs.push_back(std::make_unique<TechniqueRun>(renderer, scene, chosen.view, settings,
                                                        find_technique(technique)));
          runs.back()->run_frame(true);
        } catch (const Error& error) {
          fmt::print("{} {} {}: {}\n", technique, range, count, error.what());
          runs.resize(scenes.size());
        }
      }
      for (int frame = 0; frame < 9; ++frame) {
        for (const auto& run : runs)
          if (run) run->run_frame();
      }
      const double none = runs[0]->result().frame_ms.median;
      for (size_t i = 0; i < runs.size(); ++i) {
        if (runs[i])
          fmt::print("{},{},{},{:.2f},{:.2f}\n", technique, range, scenes[i]->lights.size() - 1,
                     runs[i]->result().frame_ms.median / none, placing[i] / none);
      }
      std::fflush(stdout);
    }
  }
}

int run(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "virtual_lights errors|times SCENE LIGHTS_FILE CAMERA [BRDF]\n");
    return 2;
  }
  Renderer renderer("", GlBackend::osmesa);
  Settings settings;
  apply_setting(settings, std::string("brdf=") + (argc > 5 ? argv[5] : "lambert"));
  (argv[1] == std::string("times") ? tell_times : tell_errors)(renderer, argv + 2, settings);
  return 0;
}

#else

int run(int, char**) {
  fmt::print(stderr, "virtual_lights: built without Embree (libembree-dev)\n");
  return 3;
}

#endif

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) { return lightgrid::run(argc, argv); }
