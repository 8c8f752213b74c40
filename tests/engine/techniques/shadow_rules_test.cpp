// The plan's rules leave out work for shadows (plan/light_shadows.h): the picture has the same bits as with
// all of it, and the work left out costs no pass, ray or memory.
#include <gmock/gmock.h>

#include <numbers>
#include <set>

#include "oracle/position.h"
#include "scene/shadow_casters.h"
#include "support/random_rooms.h"
#include "techniques/observed_run.h"
#include "techniques/shadow_stage.h"

namespace lightgrid {
using namespace lab;
namespace {

using testing::Contains;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::Not;

// Until the next look(): rays for every light that casts, whatever the rules say.
void trace_all(TechniqueRun& run) {
  FramePlan& plan = run.view().plan;
  plan.shadows.shadowed.clear();
  for (const int i : plan.lights.local)
    plan.shadows.shadowed.push_back(run.view().scene.lights[size_t(i)].casts_shadow);
  plan.shadows.needed = true;
}

// A view of a scene with the rules, and the same with all rays.
struct Ruled {
  GpuScene gpu;
  TechniqueRun ruled, full;

  Ruled(const Scene& scene, const View& view, const char* technique)
      : gpu(test_devices(), scene),
        ruled(test_devices(), gpu, view, {}, find_technique(technique)),
        full(test_devices(), gpu, view, {}, find_technique(technique)) {}

  void draw() {
    trace_all(full);
    ruled.run_frame();
    full.run_frame();
  }
  size_t rays(const TechniqueRun& run) { return run.frame().shadow_figures().rays; }
};

// Rooms with lights that each rule leaves out, and cameras that turn away and back.
TEST(ShadowRulesPicture, HasTheBitsOfAllRays) {
  Random random(77);
  std::map<ShadowNeed, size_t> lights;
  size_t ruled = 0, full = 0;
  for (int i = 0; i < 120; ++i) {
    const RandomRoom room = random_room(random, 45, 31, i % 6 == 0 ? 1e5 : 0);
    const char* technique = i % 12 == 0 ? "forward_plus" : "visibility";
    Ruled both(room.scene, room.view, technique);
    View view = room.view;
    for (int step = 0; step < 3; ++step) {
      SCOPED_TRACE(fmt::format("scene {}, {}, step {}", i, technique, step));
      both.draw();
      EXPECT_TRUE(identical(both.ruled.image(), both.full.image()));
      for (const LightShadow& light : both.ruled.view().plan.shadows.casting) ++lights[light.need];
      ruled += both.rays(both.ruled);
      full += both.rays(both.full);
      view.eye += double(random.uniform(0, 1)) * any_direction(random);
      both.ruled.look(view);
      both.full.look(view);
    }
  }
  EXPECT_LT(ruled, full);
  EXPECT_GT(ruled, full / 2);
  for (const ShadowNeed need :
       {ShadowNeed::rays, ShadowNeed::no_caster, ShadowNeed::no_receiver, ShadowNeed::casters_behind})
    EXPECT_GT(lights[need], 400u) << reason_of(need);
}

// A lamp that casts over a floor that goes past the eye, and a pane of glass before it.
Scene lamp_over_floor(glm::vec3 lamp, float radius_m) {
  SmallScene s = small_scene(false);
  Scene& scene = s.scene;
  scene.instances.clear();
  Mesh floor;
  shapes::add_quad(floor, {-5, -1, 5}, {10, 0, 0}, {0, 0, -10});
  add_instance(scene, "floor", add_mesh(scene, shapes::finished(std::move(floor), "floor", s.wall_material)));
  effect("blend").add(s);
  add_point(scene, "lamp", lamp, {1, 1, 1}, 2, radius_m).casts_shadow = true;
  return scene;
}

// Out of view.
Scene with_ball(Scene scene, const glm::dvec3& position) {
  add_instance(scene, "ball", 1, placed(position));
  return scene;
}

struct RuleCase {
  const char* name;
  Scene (*scene)();
  ShadowNeed need;
};

// A scene for each rule, whose lights all fall under it.
const RuleCase rule_cases[] = {
    {"OnlyGlassInRange",
     [] {
       return lamp_over_floor({-0.5f, 0, -1.5f}, 0.8f);
     },
     ShadowNeed::no_caster},
    {"OutOfView",
     [] {
       return lamp_over_floor({0, -0.5f, 3}, 2);
     },
     ShadowNeed::no_receiver},
    {"NothingInViewInRange",
     [] {
       return with_ball(lamp_over_floor({0, 0.4f, -0.4f}, 0.9f), {0, 1.5, 0.1});
     },
     ShadowNeed::no_receiver},
    {"TheFloorAlone",
     [] {
       return lamp_over_floor({1.5f, -0.2f, -3.2f}, 1.2f);
     },
     ShadowNeed::casters_behind},
    {"BelowTheFloor",
     [] {
       return with_ball(lamp_over_floor({0.8f, -0.5f, -1}, 1.6f), {1, -1.8, 0.3});
     },
     ShadowNeed::casters_behind},
};

struct ShadowRule : testing::TestWithParam<RuleCase> {};

// The work for shadows of a run.
struct ShadowWork {
  std::set<std::string> passes, programs;
  ShadowFigures figures;
  size_t memory = 0;
};

ShadowWork work_of_shadows(TechniqueRun& run) {
  ShadowWork work;
  run.view().renderer.note_programs(&work.programs);
  run.view().timer.clear();
  run.view().timer.enabled = true;
  run.run_frame();
  run.view().timer.enabled = false;
  run.view().renderer.note_programs(nullptr);
  for (const PassRecord& pass : run.view().timer.records()) work.passes.insert(pass.name);
  if (run.frame().shadow_figures) work.figures = run.frame().shadow_figures();
  work.memory = run.view().memory_bytes();
  return work;
}

TEST_P(ShadowRule, LeavesOutAllWorkAndNoBit) {
  const Scene scene = GetParam().scene();
  Scene bare = scene;
  for (Light& light : bare.lights) light.casts_shadow = false;
  const View view = small_view(45, 31);
  for (const char* technique : {"forward_plus", "visibility"}) {
    SCOPED_TRACE(technique);
    Ruled both(scene, view, technique);
    ASSERT_EQ(both.ruled.view().plan.shadows.casting.at(0).need, GetParam().need);
    const ShadowWork ruled = work_of_shadows(both.ruled);
    trace_all(both.full);
    const ShadowWork full = work_of_shadows(both.full);
    EXPECT_TRUE(identical(both.ruled.image(), both.full.image()));
    EXPECT_THAT(full.passes, Contains("find_shadows"));
    EXPECT_THAT(full.programs, Contains(HasSubstr("shadows/")));
    EXPECT_THAT(ruled.passes, Not(Contains("find_shadows")));
    EXPECT_THAT(ruled.passes, Not(Contains("triangle_numbers")));
    EXPECT_THAT(ruled.programs, Not(Contains(HasSubstr("shadows/"))));
    EXPECT_EQ(ruled.figures.lights + ruled.figures.rays, 0u);
    // A table that holds no tile; not the scene of rays, nor lists or bits.
    TechniqueRun without(test_devices(), bare, view, {}, find_technique(technique));
    EXPECT_EQ(ruled.memory, work_of_shadows(without).memory + both.ruled.view().shadows.bytes());
    EXPECT_EQ(ruled.figures.bytes, both.ruled.view().shadows.bytes());
    EXPECT_LE(ruled.figures.bytes, 128u);
    EXPECT_GT(full.memory, ruled.memory + 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ShadowRule, testing::ValuesIn(rule_cases),
                         [](const auto& info) { return info.param.name; });

TEST(ShadowRulesPicture, HasNoShadowsOfTheFrameBefore) {
  Scene scene = with_ball(lamp_over_floor({1.4f, -0.2f, -2.6f}, 1.2f), {});
  const View view = small_view(45, 31);
  for (const char* technique : {"forward_plus", "visibility"}) {
    scene.instances.back().world_from_object = placed({1.4, -0.7, -2.6}, 0, 0.3);
    GpuScene gpu(test_devices(), scene);
    TechniqueRun run(test_devices(), gpu, view, {}, find_technique(technique));
    run.run_frame();
    EXPECT_GT(run.frame().shadow_figures().rays, 50u);
    scene.instances.back().world_from_object = placed({0.8, 5, 8});
    SceneChanges changes;
    changes.instances = {int(scene.instances.size()) - 1};
    gpu.update(changes);
    run.look(view, changes);
    run.run_frame();
    EXPECT_FALSE(run.view().plan.shadows.needed);
    EXPECT_TRUE(identical(run.image(), render(scene, view, technique))) << technique;
  }
}

// A pixel's point may lie in the plane of its triangle, but beside it, since rasterisers move vertices: here
// a lamp reaches the point, but not the box of the wall, and a chip between them hides the lamp.
struct BesideWall {
  double off_m = 0;  // of the farthest pixel's point from the wall
  glm::dvec3 at{0}, outwards{0};
};

BesideWall farthest_beside(const View& view, const std::vector<float>& depth, double half_m,
                           const glm::dmat3& world_from_wall = glm::dmat3(1)) {
  BesideWall found;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const float d = depth[view.grid().index(x, y)];
      if (d == 0) continue;
      const glm::dvec3 at =
          glm::transpose(world_from_wall) * (view.eye + glm::transpose(glm::dmat3(view.view_from_world)) *
                                                            position_from_depth(view, x, y, double(d)));
      for (int axis = 0; axis < 2; ++axis) {
        const double off_m = std::abs(at[axis]) - half_m;
        if (off_m <= found.off_m) continue;
        found.off_m = off_m;
        found.at = at;
        found.outwards = glm::dvec3(0);
        found.outwards[axis] = at[axis] < 0 ? -1 : 1;
      }
    }
  }
  return found;
}

TEST(ShadowRulesPicture, ReckonsWithMovedVertices) {
  Random random(11);
  size_t bites = 0;
  for (int i = 0; i < 500; ++i) {
    const char* technique = i % 4 == 0 ? "forward_plus" : "visibility";
    SmallScene s = small_scene(false);
    Scene& scene = s.scene;
    scene.instances.clear();
    scene.materials[size_t(s.wall_material)].double_sided = true;
    const double size_m = random.uniform(20, 60);
    add_instance(scene, "wall",
                 add_mesh(scene, wall_mesh({0, 0, 0}, float(size_m), s.wall_material, "wall")));
    // Seen at a grazing angle, with pixels of a few metres.
    const glm::dvec3 eye(size_m * random.uniform(-1.5, 1.5), -2 * size_m, size_m * random.uniform(0.05, 0.2));
    const View view = make_view(look_at(eye, {0, 0, 0}), 48, 28);
    TechniqueRun bare(test_devices(), scene, view, {}, find_technique(technique));
    bare.run_frame();
    const BesideWall beside = farthest_beside(view, read_depth(bare), size_m);
    const double off_m = beside.off_m;
    if (off_m < 0.003) continue;
    const glm::dvec3 to_lamp = off_m * (0.5 * beside.outwards + glm::dvec3(0, 0, 1));
    add_point(scene, "lamp", glm::vec3(0), {1, 1, 1}, 1e-6f, float(1.4 * off_m)).casts_shadow = true;
    scene.lights[0].position = beside.at + to_lamp;
    const int chip = add_mesh(scene, wall_mesh({0, 0, 0}, float(0.2 * off_m), s.wall_material, "chip"));
    add_instance(scene, "chip", chip, placed(beside.at + 0.7 * to_lamp));
    Ruled both(scene, view, technique);
    both.draw();
    EXPECT_TRUE(identical(both.ruled.image(), both.full.image())) << "wall " << i << ", " << technique;
    scene.lights[0].casts_shadow = false;
    bites += !same_bytes(both.full.image(), render(scene, view, technique));
  }
  EXPECT_GT(bites, 5u) << "walls whose chip hides the lamp from a pixel";
}

// Walls of shapes whose boxes alone do not bound the errors of pixels' points. Vertex normals point through
// the wall, so that a lamp lights surfaces that the wall hides from it.
struct AnyWall {
  const char* name;
  Mesh mesh;
  glm::dmat3 world_from_wall{1};
};

// Triangles so thin that rounding turns them, along all edges.
void add_slivers(Mesh& wall, float half_m) {
  for (int i = 0; i < 4; ++i) {
    const glm::vec3 out = glm::mat3(glm::rotate(glm::dmat4(1), i * std::numbers::pi / 2, {0, 0, 1}))[0];
    const glm::vec3 along(-out.y, out.x, 0);
    for (const glm::vec3& p : {half_m * (out - along), half_m * 1.000001f * out, half_m * (out + along)}) {
      wall.indices.push_back(uint32_t(wall.positions.size()));
      wall.positions.push_back({p.x, p.y, 0});
      wall.normals.push_back({});
      wall.tangents.push_back({});
      wall.uv0.push_back({});
    }
  }
}

AnyWall any_wall(Random& random, int kind, float half_m, int material) {
  AnyWall wall{"flat", wall_mesh({0, 0, 0}, half_m, material, "wall")};
  if (kind < 2) {
    glm::dvec3 axis(0);
    axis[kind] = 1;
    wall.name = "tilted";
    wall.world_from_wall = glm::dmat3(glm::rotate(glm::dmat4(1), double(random.uniform(0.2f, 1.3f)), axis));
  } else if (kind == 2) {
    Mesh slab;
    shapes::add_box(slab, {-half_m, -half_m, -0.3f * half_m}, {half_m, half_m, 0});
    wall.name = "slab";
    wall.mesh = slab;
  } else if (kind == 3) {
    wall.name = "slivers";
    add_slivers(wall.mesh, half_m);
  }
  for (glm::vec3& normal : wall.mesh.normals) normal = {0, 0, -1};
  wall.mesh = shapes::finished(std::move(wall.mesh), wall.name, material);
  return wall;
}

// The middle pixel looks past an edge by less than 1/512 pixel. Its ray meets the wall's plane at an angle
// with a sine of 0.005 to 0.05.
View grazing_view(Random& random, double half_m, const glm::dmat3& world_from_wall) {
  const double from = random.uniform(0, 6.28f), sine = random.uniform(0.005f, 0.05f);
  const glm::dvec3 eye = 2.2 * half_m * glm::dvec3(std::cos(from), std::sin(from), sine);
  glm::dvec3 target = half_m * glm::dvec3(random.uniform(-1, 1), random.uniform(0, 1) < 0.5 ? -1 : 1, 0);
  if (random.uniform(0, 1) < 0.5) std::swap(target.x, target.y);
  const double pixel_m = glm::length(target - eye) / 27;
  target *= 1 + pixel_m / 512 * random.uniform(0.2f, 1) / sine / half_m;
  return make_view(look_at(world_from_wall * eye, world_from_wall * target), 45, 27);
}

TEST(ShadowRulesPicture, ReckonsWithMovedVerticesOfAnyWall) {
  Random random(12);
  std::map<std::string, size_t> bites;
  for (int i = 0; i < 1500; ++i) {
    const char* technique = i % 4 == 0 ? "forward_plus" : "visibility";
    SmallScene s = small_scene(false);
    Scene& scene = s.scene;
    scene.instances.clear();
    const float half_m = float(random.uniform(20, 60));
    AnyWall wall = any_wall(random, i % 5, half_m, s.wall_material);
    add_instance(scene, "wall", add_mesh(scene, std::move(wall.mesh)), glm::dmat4(wall.world_from_wall));
    const View view = grazing_view(random, double(half_m), wall.world_from_wall);
    TechniqueRun bare(test_devices(), scene, view, {}, find_technique(technique));
    bare.run_frame();
    const BesideWall beside =
        farthest_beside(view, read_depth(bare), double(half_m) * 1.00001, wall.world_from_wall);
    const double off_m = beside.off_m;
    if (off_m < 0.003) continue;
    add_point(scene, "lamp", glm::vec3(0), {1, 1, 1}, 1e-4f, float(0.55 * off_m)).casts_shadow = true;
    scene.lights[0].position =
        wall.world_from_wall * (beside.at + off_m * (0.5 * beside.outwards - glm::dvec3(0, 0, 0.1)));
    Ruled both(scene, view, technique);
    both.draw();
    EXPECT_TRUE(identical(both.ruled.image(), both.full.image()))
        << wall.name << ' ' << i << ", " << technique << ", " << off_m << " m beside it";
    scene.lights[0].casts_shadow = false;
    bites[wall.name] += !same_bytes(both.full.image(), render(scene, view, technique));
  }
  for (const char* name : {"flat", "tilted", "slab", "slivers"})
    EXPECT_GT(bites[name], 10u) << name << ": walls that hide the lamp from a pixel";
}

struct UnchangedShadows : testing::TestWithParam<const char*> {};

// With shadow-reuse. ShadowBits.FollowEveryChange has what ends it.
TEST_P(UnchangedShadows, CostNoKernelAndNoBit) {
  const Scene scene = shadowed_scene();
  GpuScene gpu(test_devices(), scene);
  const View view = small_view(45, 31);
  Settings reuse, everything_on;
  apply_setting(reuse, "shadow-reuse=on");
  apply_setting(everything_on, "shadow-reuse=on");
  apply_setting(everything_on, "everything-on=on");
  const Technique& technique = find_technique(GetParam());
  TechniqueRun without(test_devices(), gpu, view, {}, technique),
      with(test_devices(), gpu, view, reuse, technique),
      all(test_devices(), gpu, view, everything_on, technique);
  for (int frame = 0; frame < 3; ++frame) {
    SCOPED_TRACE(frame);
    if (frame == 2) {
      without.look(view);
      with.look(view);
      all.look(view);
    }
    const ShadowWork ruled = work_of_shadows(with), full = work_of_shadows(without);
    EXPECT_TRUE(identical(with.image(), without.image()));
    EXPECT_TRUE(same_bits(shadows_of(with), shadows_of(without)));
    EXPECT_THAT(full.passes, Contains("find_shadows"));
    EXPECT_GT(full.figures.rays, 100u);
    EXPECT_EQ(ruled.figures.lights, full.figures.lights);
    const FrameFigures result = with.result();
    const auto unchanged = std::ranges::count(result.shadows->skipped, std::string(unchanged_reason),
                                              &ShadowResult::Skipped::why);
    if (frame == 0) {
      EXPECT_THAT(ruled.passes, Contains("find_shadows"));
      EXPECT_EQ(unchanged, 0);
    } else {
      EXPECT_THAT(ruled.passes, Not(Contains("find_shadows")));
      EXPECT_THAT(ruled.passes, Not(Contains("triangle_numbers")));
      EXPECT_EQ(ruled.figures.rays, 0u);
      EXPECT_TRUE(ruled.figures.unchanged);
      EXPECT_EQ(size_t(unchanged), full.figures.lights);
    }
    EXPECT_THAT(work_of_shadows(all).passes, Contains("find_shadows")) << "everything-on";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, UnchangedShadows, testing::Values("deferred", "forward_plus", "visibility"),
                         [](const auto& info) { return std::string(info.param); });

TEST(KeptMaps, OnlyThoseOfAChangedLightAreDrawn) {
  Scene scene = shadowed_scene();
  GpuScene gpu(test_devices(), scene);
  const View view = small_view(45, 31);
  Settings maps;
  apply_setting(maps, "shadows=map");
  Settings reuse = maps;
  apply_setting(reuse, "shadow-reuse=on");
  TechniqueRun run(test_devices(), gpu, view, reuse, find_technique("visibility"));
  run.run_frame();
  ShadowFigures figures = run.frame().shadow_figures();
  EXPECT_GT(figures.maps, 4u);
  EXPECT_EQ(figures.drawn, figures.maps);
  scene.lights[2].position.x += 1e-3;
  const SceneChanges changes{.lights = {2}};
  gpu.update(changes);
  run.look(view, changes);
  run.run_frame();
  figures = run.frame().shadow_figures();
  EXPECT_EQ(figures.drawn, 1u);
  EXPECT_EQ(figures.kept, figures.maps - 1);
  EXPECT_TRUE(identical(run.image(), render(scene, view, "visibility", maps)));
}

// Where no light casts.

// The passes of each technique, in a scene with glass, masks, point and spot lights and a sun.
const std::map<std::string, std::vector<std::string>> recorded_passes = {
    {"forward_plus",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "cull_lights", "grid_to_gl",
      "shade_forward", "cull_lights_for_blended", "shade_blended", "read_back"}},
    {"light_prepass",
     {"fill_normals", "depth_to_cl", "depth_bounds", "tile_distances", "normals_to_cl", "cull_lights",
      "fill_light_buffer", "light_buffer_to_gl", "shade_forward", "cull_lights_for_blended", "grid_to_gl",
      "shade_blended", "read_back"}},
    {"visibility",
     {"rasterize", "depth_bounds", "cull_lights", "resolve", "cull_lights_for_blended", "list_blended",
      "blend_resolved", "read_back"}},
    {"forward",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "shade_forward", "shade_blended",
      "read_back"}},
    {"forward_multipass",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "find_object_lights", "shade_objects",
      "find_blended_object_lights", "shade_blended", "read_back"}},
    {"forward_zprepass",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "find_object_lights", "shade_objects",
      "find_blended_object_lights", "shade_blended", "read_back"}},
    {"clustered",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "cull_lights", "grid_to_gl",
      "shade_forward", "cull_lights_for_blended", "shade_blended", "read_back"}},
    {"forward_plus_compute",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "fill_gbuffer", "cull_lights",
      "gbuffer_to_cl", "shade_tiles", "image_to_gl", "cull_lights_for_blended", "grid_to_gl", "shade_blended",
      "read_back"}},
    {"deferred",
     {"fill_gbuffer", "shade_light_volumes", "find_blended_object_lights", "shade_blended", "read_back"}},
    {"deferred_tiled",
     {"fill_gbuffer", "depth_to_cl", "depth_bounds", "cull_lights", "gbuffer_to_cl", "shade_tiles",
      "image_to_gl", "cull_lights_for_blended", "grid_to_gl", "shade_blended", "read_back"}},
    {"lidr",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "light_volumes", "light_index",
      "shade_forward", "find_blended_object_lights", "shade_blended", "read_back"}},
    {"voxel_lights",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "place_voxels", "build_voxels",
      "voxels_to_gl", "shade_forward", "shade_blended", "read_back"}},
    {"world_grid",
     {"depth_prepass", "depth_to_cl", "depth_bounds", "tile_distances", "build_world_grid", "grid_to_gl",
      "shade_forward", "shade_blended", "read_back"}},
};

Scene scene_without_shadows() {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "mask", "spot", "directional"}) effect(name).add(s);
  return s.scene;
}

struct NoShadows : testing::TestWithParam<const Technique*> {};

TEST_P(NoShadows, CostNothing) {
  const Technique& technique = *GetParam();
  const View view = small_view(33, 19);
  Scene scene = scene_without_shadows();
  {
    TechniqueRun run(test_devices(), scene, view, {}, technique);
    run.view().timer.enabled = true;
    run.run_frame();
    std::vector<std::string> passes;
    for (const PassRecord& pass : run.view().timer.records()) passes.push_back(pass.name);
    EXPECT_THAT(passes, ElementsAreArray(recorded_passes.at(technique.name)));
    EXPECT_FALSE(run.frame().shadows || run.frame().shadow_figures || run.result().shadows);
    EXPECT_EQ(run.view().shadows.bytes(), 0u);
  }
  const Observed none = observe(test_devices(), scene, view, technique, {});
  EXPECT_THAT(none.at("programs"), Not(HasSubstr("SHADOW")));
  EXPECT_THAT(none.at("programs"), Not(HasSubstr("shadows/")));
  for (Light& light : scene.lights) light.casts_shadow = true;
  if (technique.name != std::string("voxel_lights")) {
    const Observed all = observe(test_devices(), scene, view, technique, {});
    EXPECT_THAT(all.at("programs"), HasSubstr("SHADOWS"));
    EXPECT_TRUE(all.contains("pass find_shadows"));
    EXPECT_NE(all.at("memory"), none.at("memory"));
  } else {
    EXPECT_EQ(observe(test_devices(), scene, view, technique, {}), none) << "it has none";
  }
  choose_shadow_casters(scene, 0);
  EXPECT_EQ(observe(test_devices(), scene, view, technique, {}), none) << "--shadows none";
}

INSTANTIATE_TEST_SUITE_P(Techniques, NoShadows, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

}  // namespace
}  // namespace lightgrid
