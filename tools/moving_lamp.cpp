// The time of a `visibility` frame in which one thing moves, with shadow-reuse off and on, in turn: a lamp, an
// object, or the camera. Each moves for five frames, then the next one does. CSV; docs/shadows.md has figures.
//   moving_lamp [SCENE [WxH [FRAMES]]]
#include <fmt/format.h>

#include <algorithm>

#include "base/timer.h"
#include "run/scene_choice.h"
#include "run/technique_run.h"

namespace lightgrid {
namespace {

constexpr glm::dvec3 step{0.05, 0, 0};
constexpr int frames_each = 5;

// The smaller half of the instances.
std::vector<int> small_instances(const Scene& scene) {
  std::vector<std::pair<double, int>> sizes;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const WorldBox box = world_box(scene.meshes[size_t(instance.mesh)], instance.world_from_object);
    sizes.emplace_back(glm::length(box.max - box.min), int(i));
  }
  std::ranges::sort(sizes);
  std::vector<int> small;
  for (size_t i = 0; i < (sizes.size() + 1) / 2; ++i) small.push_back(sizes[i].second);
  return small;
}

SceneChanges move(Scene& scene, View& view, const std::string& what, int frame) {
  const size_t turn = size_t(frame / frames_each) * 17;
  SceneChanges changes;
  if (what == "lamp") {
    changes.lights.push_back(int(turn % scene.lights.size()));
    scene.lights[size_t(changes.lights[0])].position += step;
  } else if (what == "object") {
    const std::vector<int> small = small_instances(scene);
    changes.instances.push_back(small[turn % small.size()]);
    scene.instances[size_t(changes.instances[0])].world_from_object[3] += glm::dvec4(step, 0);
  } else {
    view.eye += 0.2 * step;
    view.view_from_world[3] = glm::dvec4(-(glm::dmat3(view.view_from_world) * view.eye), 1);
  }
  return changes;
}

struct Measured {
  std::unique_ptr<TechniqueRun> run;
  std::vector<double> frame_ms, find_ms, rays, kept;
};

double find_shadows_ms(const TechniqueRun& run) {
  for (const PassRecord& pass : run.view().timer.records())
    if (pass.name == "find_shadows") return pass.ms.back();
  return 0;
}

void measure(Renderer& renderer, const SceneChoice& choice, const std::string& what, int frames) {
  ChosenScene chosen = load_chosen_scene(choice);
  GpuScene gpu(renderer, chosen.scene);
  Measured measured[2];
  for (int on = 0; on < 2; ++on) {
    Settings settings;
    apply_setting(settings, on ? "shadow-reuse=on" : "shadow-reuse=off");
    measured[on].run =
        std::make_unique<TechniqueRun>(renderer, gpu, chosen.view, settings, find_technique("visibility"));
    for (int i = 0; i < 3; ++i) measured[on].run->run_frame(true);
  }
  for (int frame = 0; frame < frames; ++frame) {
    const SceneChanges changes = move(chosen.scene, chosen.view, what, frame);
    gpu.update(changes);
    for (int k = 0; k < 2; ++k) {
      Measured& m = measured[(frame + k) % 2];
      m.run->look(chosen.view, changes);
      PassTimer& timer = m.run->view().timer;
      timer.enabled = frame % 2;
      const double ms = m.run->run_frame(true);
      timer.enabled = false;
      if (frame % 2)
        m.find_ms.push_back(find_shadows_ms(*m.run));
      else
        m.frame_ms.push_back(ms);
      const ShadowFigures figures = m.run->frame().shadow_figures();
      m.rays.push_back(double(figures.rays));
      m.kept.push_back(double(figures.tiles_kept));
    }
  }
  for (int on = 0; on < 2; ++on) {
    const Measured& m = measured[on];
    fmt::print("{},{},{},{},{:.2f},{:.2f},{:.0f},{:.0f}\n", choice.scene, choice.size, what,
               on ? "on" : "off", spread_of(m.frame_ms).median, spread_of(m.find_ms).median,
               spread_of(m.rays).median, spread_of(m.kept).median);
  }
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  SceneChoice choice;
  choice.scene = argc > 1 ? argv[1] : "hall";
  choice.size = argc > 2 ? argv[2] : "1280x720";
  choice.shadows = "all";
  Renderer renderer("", GlBackend::none);
  fmt::print("scene,size,moves,shadow-reuse,frame_ms,find_shadows_ms,rays,tiles_kept\n");
  for (const char* what : {"lamp", "object", "camera"})
    measure(renderer, choice, what, argc > 3 ? std::atoi(argv[3]) : 60);
  return 0;
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) { return lightgrid::run(argc, argv); }
