// Virtual lights as placed by what lights see: on surfaces, with the flux that these reflect, the same each
// time, and lit alike by techniques.
#include "run/virtual_lights.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "measures/results.h"
#include "run/scene_choice.h"
#include "scenes/builtin.h"
#include "support/devices.h"
#include "support/small_scene.h"

namespace lightgrid {
using namespace lab;
namespace {

using glm::dvec3;
using std::numbers::pi;

constexpr double albedo = 0.5;

Settings lambert(const char* more = nullptr) {
  Settings s;
  apply_setting(s, "brdf=lambert");
  if (more) apply_setting(s, more);
  return s;
}

// A closed room around the origin, grey inside, with one light.
Scene closed_room(Mesh mesh, const Light& light) {
  Scene scene;
  scene.name = "closed room";
  const int grey = add_material(scene, "grey", glm::vec3(albedo), 0, 1);
  scene.materials[size_t(grey)].double_sided = true;
  add_instance(scene, "walls", add_mesh(scene, shapes::finished(std::move(mesh), "walls", grey)));
  scene.ambient = glm::vec3(0);
  scene.lights = {light};
  return scene;
}

Mesh box_mesh() {
  Mesh mesh;
  shapes::add_box(mesh, {-3, -1.5f, -2}, {3, 2, 4});
  return mesh;
}

Light lamp(double candela) {
  Light light;
  light.name = "lamp";
  light.position = {0.3, 0.2, -0.1};
  light.intensity = float(candela);
  return light;
}

Light spot_lamp(double candela, float outer_rad) {
  Light light = lamp(candela);
  light.type = LightType::spot;
  light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  light.inner_cone_rad = 0.3f;
  light.outer_cone_rad = outer_rad;
  return light;
}

std::vector<Light> virtual_ones(const Scene& scene) {
  std::vector<Light> lights = scene.lights;
  std::erase_if(lights, [](const Light& l) { return !l.is_virtual; });
  return lights;
}

void place(Scene& scene, const VirtualLightSettings& choice, const Settings& settings = lambert()) {
  VirtualLights(scene, test_device_name(), settings, choice).place();
}

double flux_of(const Scene& scene) {
  double flux = 0;
  for (const Light& light : virtual_ones(scene)) flux += double(light.intensity) * light.color.g * pi;
  return flux;
}

// Every wall reflects its albedo of what reaches it, and no light leaves: 4 pi I of a point light. A spot's
// intensity is I t^2, t from 1 to 0 linear in the cosine between its cones: a third of that ring's.
TEST(PlacedVirtualLights, HaveTheFluxThatSurfacesReflect) {
  Scene scene = closed_room(box_mesh(), lamp(10));
  place(scene, {.count = 300});
  ASSERT_EQ(virtual_ones(scene).size(), 300u);
  EXPECT_NEAR(flux_of(scene) / (albedo * 4 * pi * 10), 1, 2e-5);
  for (const float outer : {0.8f, 1.45f}) {  // one view, and six
    Scene of_spot = closed_room(box_mesh(), spot_lamp(10, outer));
    place(of_spot, {.count = 300});
    const double whole = 1 - std::cos(0.3), ring = std::cos(0.3) - std::cos(double(outer));
    EXPECT_NEAR(flux_of(of_spot) / (albedo * 2 * pi * 10 * (whole + ring / 3)), 1, 5e-4) << outer;
  }
}

// The views that place them have no effects of base lighting.
TEST(PlacedVirtualLights, AreTheSameWithFarLight) {
  Settings settings = lambert("range=cutoff");
  Scene without = closed_room(box_mesh(), lamp(10)), with = without;
  place(without, {.count = 50}, settings);
  apply_setting(settings, "far-light=512");
  place(with, {.count = 50}, settings);
  const std::vector<Light> expected = virtual_ones(without), found = virtual_ones(with);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.size(), 50u);
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].position, expected[i].position) << i;
    EXPECT_EQ(found[i].intensity, expected[i].intensity) << i;
  }
}

TEST(PlacedVirtualLights, StandOnSurfacesAndFaceTheLight) {
  Scene scene = closed_room(box_mesh(), lamp(10));
  place(scene, {.count = 500});
  for (const Light& light : virtual_ones(scene)) {
    const dvec3 &p = light.position, n = light.direction;
    // From the wall that the light faces away from; 1/64 of a pixel's width is at most 1 mm here.
    const double above = std::abs(n.x) > 0.9   ? (n.x > 0 ? p.x + 3 : 3 - p.x)
                         : std::abs(n.y) > 0.9 ? (n.y > 0 ? p.y + 1.5 : 2 - p.y)
                                               : (n.z > 0 ? p.z + 2 : 4 - p.z);
    EXPECT_GT(above, 0) << light.name;
    EXPECT_LT(above, 1e-3) << light.name;
    EXPECT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1, 1e-5);
  }
}

// In a sphere cos cos / d^2 is 1 / 4 R^2 between any two points, so that each virtual light adds the same
// everywhere: E = albedo I / R^2 for a light in the centre.
TEST(PlacedVirtualLights, LightASphereEvenlyInEveryTechnique) {
  constexpr double radius = 2, candela = 30;
  Mesh mesh;
  shapes::add_sphere(mesh, {0, 0, 0}, float(radius), 24);
  Light light = lamp(candela);
  light.position = {0, 0, 0};
  Scene scene = closed_room(std::move(mesh), light);
  place(scene, {.count = 256, .nearest_m = 0});
  scene.lights = virtual_ones(scene);
  const View view = make_view(look_at({0.5, 0.3, 0.8}, {0.2, 0.1, -1}), 96, 54);
  const double expected = albedo / pi * albedo * candela / (radius * radius);
  Image first;
  for (const char* technique :
       {"forward", "forward_plus", "clustered", "visibility", "deferred_tiled", "lidr"}) {
    Scene few = scene;
    const bool lidr = technique == std::string("lidr");
    if (lidr) few.lights.resize(8);  // as many as its pixels hold
    TechniqueRun run(software_devices(), few, view, lambert(), find_technique(technique));
    run.run_frame();
    const double share = double(few.lights.size()) / double(scene.lights.size());
    size_t near = 0;
    for (size_t i = 0; i < run.image().pixels.size(); ++i)
      near += std::abs(double(run.image().pixels[i].g) / (expected * share) - 1) < 0.02;
    // Next to a light its facet and its neighbours are no sphere, which shows in a sum of eight.
    EXPECT_GT(near, run.image().pixels.size() * (lidr ? 90 : 99) / 100) << technique;
    if (technique == std::string("forward")) first = run.image();
    if (technique == std::string("forward_plus")) {
      EXPECT_EQ(first.pixels, run.image().pixels) << "bit for bit";
    }
  }
}

TEST(PlacedVirtualLights, AreTheSameBytesInBothKernelShapesAndEachTime) {
  Scene hall = find_builtin_scene("hall")->make();
  std::vector<std::vector<Light>> placed;
  for (const char* shape : {"kernel-shape=lanes", "kernel-shape=group", "kernel-shape=lanes"}) {
    Settings settings;
    apply_setting(settings, shape);
    VirtualLights lights(hall, test_device_name(), settings, {.count = 200, .from = 2});
    lights.place();
    EXPECT_EQ(lights.reflected(), 2u);
    placed.push_back(virtual_ones(hall));
    lights.place();
    EXPECT_EQ(placed.back(), virtual_ones(hall)) << "again";
  }
  ASSERT_EQ(placed[0].size(), 200u);
  EXPECT_EQ(placed[0], placed[1]);
  EXPECT_EQ(placed[0], placed[2]);
}

TEST(PlacedVirtualLights, FollowALightThatMoves) {
  Scene scene = closed_room(box_mesh(), lamp(10));
  VirtualLights placed(scene, test_device_name(), lambert(), {.count = 64});
  placed.place();
  const View view = make_view(look_at({-2, 0, 0}, {2, 0, 1}), 64, 36);
  GpuScene gpu(software_devices(), scene);
  TechniqueRun run(software_devices(), gpu, view, lambert(), find_technique("forward_plus"));
  run.run_frame();
  const Image before = run.image();
  EXPECT_EQ(to_json(RunResult{run.result()})["lights"]["virtual"], 64);
  EXPECT_TRUE(placed.follow({}).empty()) << "nothing moved";
  scene.lights[0].position = {-1, 1, 1.5};
  const SceneChanges changes = placed.follow({.lights = {0}});
  EXPECT_GT(changes.lights.size(), 60u);
  EXPECT_TRUE(std::ranges::is_sorted(changes.lights));
  gpu.update(changes);
  run.look(view, changes);
  run.run_frame();
  Light moved = lamp(10);
  moved.position = {-1, 1, 1.5};
  Scene fresh = closed_room(box_mesh(), moved);
  place(fresh, {.count = 64});
  EXPECT_EQ(scene.lights, fresh.lights);
  TechniqueRun again(software_devices(), fresh, view, lambert(), find_technique("forward_plus"));
  again.run_frame();
  EXPECT_EQ(run.image().pixels, again.image().pixels);
  EXPECT_NE(run.image().pixels, before.pixels);
}

// The scene's own lights are neither moved nor lost, motion by rig leaves virtual ones to the placing, and
// the plan names them.
TEST(PlacedVirtualLights, JoinTheScenesLightsByTheirOption) {
  SceneChoice choice;
  choice.size = "64x36";
  choice.virtual_lights = 20;
  choice.virtual_from = "1";
  choice.light_motion = "orbit";
  ChosenScene chosen = load_chosen_scene(choice);
  const size_t own = chosen.scene.lights.size() - 20;
  EXPECT_EQ(virtual_ones(chosen.scene).size(), 20u);
  EXPECT_TRUE(chosen.scene.lights[own].is_virtual && !chosen.scene.lights[own - 1].is_virtual);
  const FramePlan plan = plan_frame(chosen.scene, chosen.view, {}, {});
  const auto told = std::ranges::find(plan.decisions, "virtual lights", &Decision::effect);
  ASSERT_NE(told, plan.decisions.end());
  EXPECT_TRUE(told->needed);
  EXPECT_THAT(told->why, testing::StartsWith("20 of 257 lights"));
  const SceneMotion advance = chosen_motion(chosen.scene, choice);
  const std::vector<Light> before = virtual_ones(chosen.scene);
  EXPECT_TRUE(advance(0).lights.empty()) << "at rest, and placed as before";
  advance(9);
  EXPECT_NE(before, virtual_ones(chosen.scene));
  for (const char* wrong : {"0", "x"}) {
    choice.virtual_from = wrong;
    EXPECT_THROW(load_chosen_scene(choice), Error) << wrong;
  }
  choice.virtual_from = "all";
  choice.virtual_lights = 0;
  EXPECT_THROW(load_chosen_scene(choice), Error) << "without virtual-lights";
}

}  // namespace
}  // namespace lightgrid
