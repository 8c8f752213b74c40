// With shadow-reuse a pair of a tile and a light keeps its bits while neither the camera, the tile's pixels, the
// light nor a caster in its range changes. Frames equal those of a run that begins with them.
#include <gmock/gmock.h>

#include "plan/settings/shadows.h"
#include "scene/rig.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {
using namespace lab;
namespace {

struct KeptCase {
  const char *name, *technique;
  std::string settings;
  bool keeps = true;
  size_t memory = 256 << 20;
};

struct Change {
  const char* name;
  std::function<SceneChanges(Scene&)> make;
};

SceneChanges move_light(Scene& scene, int i, double by) {
  scene.lights[size_t(i)].position.x += by;
  return {.lights = {i}};
}

SceneChanges move_instance(Scene& scene, int i, double by) {
  scene.instances[size_t(i)].world_from_object[3].x += by;
  return {.instances = {i}};
}

SceneChanges deform(Scene& scene, int instance, float by) {
  const int number = scene.instances[size_t(instance)].mesh;
  Mesh& mesh = scene.meshes[size_t(number)];
  mesh.bounds = {};
  for (glm::vec3& p : mesh.positions) {
    p.z += by * p.y;
    mesh.bounds.add(p);
  }
  return {.meshes = {number}};
}

// The camera rests. Each change twice or more, since a tile's pixels are first known after one.
std::vector<Change> changes() {
  return {
      {"a light moved", [](Scene& s) { return move_light(s, 2, 0.05); }},
      {"it moved again", [](Scene& s) { return move_light(s, 2, -0.02); }},
      {"the ball moved", [](Scene& s) { return move_instance(s, 1, 0.03); }},
      {"the ball moved again", [](Scene& s) { return move_instance(s, 1, 0.03); }},
      {"the fence moved", [](Scene& s) { return move_instance(s, 2, 1e-6); }},
      {"the wall moved in its plane", [](Scene& s) { return move_instance(s, 0, 1e-3); }},
      {"a light became brighter",
       [](Scene& s) {
         s.lights[2].intensity *= 2;
         return SceneChanges{.lights = {2}};
       }},
      {"a light reaches less far",
       [](Scene& s) {
         s.lights[2].radius_m = 2.5f;
         return SceneChanges{.lights = {2}};
       }},
      {"two lights swapped",
       [](Scene& s) {
         std::swap(s.lights[0], s.lights[2]);
         return SceneChanges{.lights = {0, 2}};
       }},
      {"a light is gone",
       [](Scene& s) {
         s.lights[0].intensity = s.lights[0].radius_m = 0;
         return SceneChanges{.lights = {0}};
       }},
      {"a light and an object moved",
       [](Scene& s) {
         SceneChanges all = move_light(s, 2, 0.1);
         all.instances = move_instance(s, 3, -0.05).instances;
         return all;
       }},
      {"a light came back",
       [](Scene& s) {
         s.lights[0].intensity = 3;
         s.lights[0].radius_m = 4;
         return SceneChanges{.lights = {0}};
       }},
      {"the fence deformed", [](Scene& s) { return deform(s, 2, 0.2f); }},
      {"the fence deformed again", [](Scene& s) { return deform(s, 2, -0.1f); }},
      {"the pane moved", [](Scene& s) { return move_instance(s, int(s.instances.size()) - 1, 0.05); }},
      {"the sun turned",
       [](Scene& s) {
         const int sun = int(s.lights.size()) - 1;
         s.lights[size_t(sun)].direction = glm::normalize(glm::vec3(0.2f, -1, -0.4f));
         return SceneChanges{.lights = {sun}};
       }},
      {"a light moved at last", [](Scene& s) { return move_light(s, 2, 0.05); }},
  };
}

struct KeptPairsOf : testing::TestWithParam<KeptCase> {};

TEST_P(KeptPairsOf, EqualThoseOfAFreshFrame) {
  Scene scene = shadowed_scene();
  auto rig = std::make_shared<Rig>();
  rig->meshes.push_back({.mesh = scene.instances[2].mesh});
  scene.rig = rig;
  GpuScene gpu(test_devices(), scene);
  const View view = small_view(173, 101);
  Settings settings = assigned(GetParam().settings),
           reuse = assigned("shadow-reuse=on " + GetParam().settings);
  for (Settings* each : {&settings, &reuse}) each->set(setting::shadow_memory, GetParam().memory);
  const Technique& technique = find_technique(GetParam().technique);
  TechniqueRun run(test_devices(), gpu, view, reuse, technique);
  run.run_frame();
  EXPECT_EQ(run.frame().shadow_figures().tiles_kept, 0u);
  size_t kept = 0, rays = 0, all_rays = 0;
  for (const Change& change : changes()) {
    SCOPED_TRACE(change.name);
    const SceneChanges what = change.make(scene);
    gpu.update(what);
    run.look(view, what);
    run.run_frame();
    TechniqueRun fresh(test_devices(), scene, view, settings, technique);
    fresh.run_frame();
    const HostShadows ours = shadows_of(run), all = shadows_of(fresh);
    EXPECT_TRUE(same_bits(ours, all));
    EXPECT_EQ(ours.shares, all.shares);
    EXPECT_TRUE(identical(run.image(), fresh.image()));
    kept += run.frame().shadow_figures().tiles_kept;
    rays += run.frame().shadow_figures().rays;
    all_rays += fresh.frame().shadow_figures().rays;
  }
  EXPECT_EQ(kept > 100, GetParam().keeps) << kept;
  EXPECT_EQ(rays < all_rays, GetParam().keeps) << rays << " of " << all_rays;
}

INSTANTIATE_TEST_SUITE_P(Of, KeptPairsOf,
                         testing::Values(KeptCase{"Visibility", "visibility", ""},
                                         KeptCase{"Groups", "visibility", "kernel-shape=group"},
                                         KeptCase{"Spheres", "visibility", "shadow-rays=4"},
                                         KeptCase{"GroupsOfSpheres", "visibility",
                                                  "shadow-rays=4 kernel-shape=group"},
                                         KeptCase{"Samples", "visibility", "samples=4"},
                                         KeptCase{"Alpha", "visibility", "shadow-blended=alpha"},
                                         KeptCase{"Tree", "visibility", "shadow-cells=off"},
                                         KeptCase{"OpenGl", "forward_plus", ""},
                                         KeptCase{"Deferred", "deferred_tiled", "raster=opencl"},
                                         KeptCase{"LittleMemory", "visibility", "", false, 8 << 10},
                                         KeptCase{"Picked", "visibility", "shadow-pick=4", false}),
                         [](const auto& info) { return std::string(info.param.name); });

// One moving lamp costs the rays of that lamp.
TEST(KeptPairs, OfAllOtherLightsTakeNoRay) {
  Scene scene = shadowed_scene();
  GpuScene gpu(test_devices(), scene);
  const View view = small_view(173, 101);
  const Settings reuse = assigned("shadow-reuse=on");
  TechniqueRun run(test_devices(), gpu, view, reuse, find_technique("visibility"));
  run.run_frame();
  const SceneChanges moved = move_light(scene, 2, 0.05);
  gpu.update(moved);
  run.look(view, moved);
  run.run_frame();
  Scene only = scene;
  for (size_t i = 0; i < only.lights.size(); ++i) only.lights[i].casts_shadow = i == 2;
  TechniqueRun alone(test_devices(), only, view, {}, find_technique("visibility"));
  alone.run_frame();
  EXPECT_GT(alone.frame().shadow_figures().rays, 500u);
  EXPECT_EQ(run.frame().shadow_figures().rays, alone.frame().shadow_figures().rays);
  run.run_frame();
  EXPECT_EQ(run.frame().shadow_figures().rays, 0u);
  const auto has_lights = [](glm::uvec2 cell) { return cell.y > 0; };
  EXPECT_EQ(run.frame().shadow_figures().tiles_kept,
            size_t(std::ranges::count_if(shadows_of(run).cells, has_lights)));
}

// A moving camera keeps nothing, and takes no memory for what could be kept.
TEST(KeptPairs, EndWhereTheCameraMoves) {
  const Scene scene = shadowed_scene();
  GpuScene gpu(test_devices(), scene);
  View view = small_view(173, 101);
  const Settings reuse = assigned("shadow-reuse=on");
  TechniqueRun run(test_devices(), gpu, view, reuse, find_technique("visibility")),
      without(test_devices(), gpu, view, {}, find_technique("visibility"));
  for (int i = 0; i < 3; ++i) {
    run.run_frame();
    without.run_frame();
    EXPECT_EQ(run.frame().shadow_figures().tiles_kept, 0u);
    EXPECT_EQ(run.frame().shadow_figures().rays, without.frame().shadow_figures().rays);
    EXPECT_EQ(run.frame().shadow_figures().bytes, without.frame().shadow_figures().bytes);
    view = make_view(look_at({0.1 * i, 0.3, 0.2}, {0, 0, -4}), 173, 101);
    run.look(view);
    without.look(view);
  }
}

}  // namespace
}  // namespace lightgrid
