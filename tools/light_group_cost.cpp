// The cost per pixel of a light outside a mesh's group, in each technique and way of groups: frames of
// `rooms`, of rooms with lights that reach every pixel and are of a group that no surface has, and of rooms
// in which the same lights light all, in turn. CSV; docs/light_groups.md has the table.
//   light_group_cost [WxH [LIGHTS [FRAMES]]]
// Or the shadow rays of `rooms` with its groups and without, per camera, where all lights cast shadows:
//   light_group_cost rays [WxH]
#include <fmt/format.h>

#include <sstream>

#include "run/technique_run.h"
#include "scene/light_groups.h"
#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"

namespace lightgrid {
namespace {

constexpr std::pair<const char*, const char*> ways[] = {
    {"forward", ""},
    {"forward_multipass", ""},
    {"forward_zprepass", ""},
    {"forward_plus", "group-tiles=off"},
    {"forward_plus", ""},
    {"clustered", "group-tiles=off"},
    {"clustered", ""},
    {"world_grid", ""},
    {"deferred", ""},
    {"deferred", "group-ids=16"},
    {"deferred", "group-stencil=8"},
    {"deferred", "volume-culling=scissor"},
    {"deferred", "volume-culling=scissor group-stencil=8"},
    {"deferred_tiled", "group-tiles=off"},
    {"deferred_tiled", ""},
    {"deferred_tiled", "group-ids=16"},
    {"forward_plus_compute", "group-tiles=off"},
    {"forward_plus_compute", ""},
    {"light_prepass", "group-tiles=off"},
    {"light_prepass", ""},
    {"lidr", "lidr-overlap=16"},
    {"visibility", "group-tiles=off"},
    {"visibility", ""},
    {"visibility", "group-tiles=off kernel-shape=group"},
    {"visibility", "kernel-shape=group"},
};

Scene with_more(Scene scene, int lights, uint32_t groups) {
  Random random(7);
  for (int i = 0; i < lights; ++i) {
    const glm::vec3 at(random.uniform(-8, 8), random.uniform(0.5f, 2.8f), random.uniform(-11, -1));
    set_groups(add_point(scene, fmt::format("more {}", i), at, {1, 1, 1}, 0.05f, 40), groups);
  }
  return scene;
}

Scene without_groups(Scene scene) {
  for (Light& light : scene.lights) set_groups(light, all_groups);
  for (Instance& instance : scene.instances) set_groups(instance, all_groups);
  return scene;
}

int print_rays(const std::string& size) {
  const int width = std::atoi(size.c_str()), height = std::atoi(size.c_str() + size.find('x') + 1);
  Renderer renderer("", GlBackend::none);
  const auto all_casting = [](Scene scene) {
    for (Light& light : scene.lights) light.casts_shadow = true;
    return scene;
  };
  const Scene grouped = all_casting(find_builtin_scene("rooms")->make()), plain = without_groups(grouped);
  fmt::print("camera,rays with groups,rays without,share\n");
  for (const Camera& camera : grouped.cameras) {
    const View view = make_view(camera, width, height);
    size_t rays[2], i = 0;
    for (const Scene* scene : {&grouped, &plain}) {
      TechniqueRun run(renderer, *scene, view, {}, find_technique("visibility"));
      run.run_frame();
      rays[i++] = run.result().shadows->rays;
    }
    fmt::print("{},{},{},{:.3f}\n", camera.name, rays[0], rays[1], double(rays[0]) / double(rays[1]));
  }
  return 0;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "rays") return print_rays(argc > 2 ? argv[2] : "640x360");
  const std::string size = argc > 1 ? argv[1] : "640x360";
  const int lights = argc > 2 ? std::atoi(argv[2]) : 8, frames = argc > 3 ? std::atoi(argv[3]) : 15;
  const int width = std::atoi(size.c_str()), height = std::atoi(size.c_str() + size.find('x') + 1);
  Renderer renderer("", GlBackend::automatic);
  const Scene own = find_builtin_scene("rooms")->make();
  const Scene masked = with_more(own, lights, 1u << 20), lit = with_more(own, lights, all_groups);
  const View view = make_view(choose_camera(own, ""), width, height);
  fmt::print("technique,settings,masked over own,lit over own,masked over lit\n");
  for (const auto& [technique, assignments] : ways) {
    Settings settings;
    std::istringstream words(assignments);
    for (std::string word; words >> word;) apply_setting(settings, word);
    std::vector<std::unique_ptr<TechniqueRun>> runs;
    for (const Scene* scene : {&own, &masked, &lit}) {
      runs.push_back(
          std::make_unique<TechniqueRun>(renderer, *scene, view, settings, find_technique(technique)));
      for (int i = 0; i < 3; ++i) runs.back()->run_frame(true);
    }
    for (int frame = 0; frame < frames; ++frame)
      for (const auto& r : runs) r->run_frame();
    double ms[3];
    for (size_t i = 0; i < 3; ++i) ms[i] = runs[i]->result().frame_ms.median;
    fmt::print("{},{},{:.3f},{:.3f},{:.3f}\n", technique, assignments, ms[1] / ms[0], ms[2] / ms[0],
               (ms[1] - ms[0]) / (ms[2] - ms[0]));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace lightgrid

int main(int argc, char** argv) { return lightgrid::run(argc, argv); }
