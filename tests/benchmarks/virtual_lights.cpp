// Virtual lights by count and clamp: error against the truth of one bounce, and time against a frame without
// them, as CSV. Needs Embree. docs/fake_radiosity.md has the tables.
//   virtual_lights SCENE LIGHTS_FILE CAMERA [BRDF]
#include <fmt/format.h>

#include "base/timer.h"
#include "session/contestants.h"
#include "session/scene_choice.h"
#include "support/virtual_light_error.h"

namespace lightgrid {
namespace {

#ifdef LIGHTGRID_EMBREE

constexpr std::array counts = {64, 256, 1024, 4096};

ChosenScene load(const std::string& size, const char* const* arguments) {
  SceneChoice choice;
  choice.scene = arguments[0], choice.lights_file = arguments[1], choice.camera = arguments[2];
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
  fmt::print("count,nearest,shadows,bias,rms,spread\n");
  for (const int count : counts) {
    for (const double nearest : {0.0, -1.0, 0.1, 0.5, 1.0}) {
      for (const bool shadows : {true, false}) {
        if (count == 4096 && nearest > 0 && nearest != 0.5) continue;
        const VirtualLightError e = seen.error({.count = count, .nearest_m = nearest}, shadows, 4);
        fmt::print("{},{},{},{:.4f},{:.4f},{:.4f}\n", count,
                   nearest < 0 ? "auto" : fmt::format("{:g}", nearest), shadows ? "exact" : "none", e.bias,
                   e.rms, e.spread);
        std::fflush(stdout);
      }
    }
  }
}

// Frames of all counts in turn, over those without virtual lights.
void tell_times(Renderer& renderer, const char* const* arguments, const Settings& given) {
  fmt::print("technique,range,count,frame over none,placing over a frame of none\n");
  for (const char* range : {"range=scene", "range=cutoff"}) {
    Settings settings = given;
    apply_setting(settings, range);
    apply_setting(settings, "cutoff=0.005");
    for (const char* technique : {"forward_plus", "visibility", "lidr"}) {
      std::vector<std::unique_ptr<Scene>> scenes;
      std::vector<std::unique_ptr<TechniqueRun>> runs;
      std::vector<double> placing;
      const ChosenScene chosen = load("640x360", arguments);
      for (const int count : {0, 64, 256, 1024, 4096}) {
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
  if (argc < 4) {
    fmt::print(stderr, "virtual_lights SCENE LIGHTS_FILE CAMERA [BRDF]\n");
    return 2;
  }
  Renderer renderer("", GlBackend::osmesa);
  Settings settings;
  apply_setting(settings, std::string("brdf=") + (argc > 4 ? argv[4] : "lambert"));
  tell_errors(renderer, argv + 1, settings);
  if (argc < 6) tell_times(renderer, argv + 1, settings);
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
