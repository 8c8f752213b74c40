// Shadows that are kept from frame to frame (shadow-reuse) are those of fresh frames to the bit, whatever
// moves.
#include <gmock/gmock.h>

#include <cmath>

#include "scene/camera_path.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// A room with a floor of many triangles, walls of two each, balls, a box, a mirrored and stretched ball, a
// hedge of masked leaves and a cloth; ten lights, two of them spots. All of it lies `offset` from the world's
// origin.
struct MovingRoom {
  Scene scene;
  dvec3 offset;
  int sun = -1;  // its light, if there is one
  int leaf, cloth_mesh, ball, box, mirrored, hedge, cloth;

  explicit MovingRoom(const dvec3& at) : offset(at) {
    const int plaster = add_material(scene, "plaster", {0.7f, 0.6f, 0.5f}, 0, 0.8f);
    leaf = add_material(scene, "leaf", {0.3f, 0.7f, 0.2f}, 0, 0.9f);
    scene.materials[size_t(leaf)].alpha_mode = AlphaMode::mask;
    scene.materials[size_t(leaf)].base_color_map.texture = add_speckles(scene, true);
    const auto place = [&](const char* name, int mesh, dvec3 position, dvec3 scale = dvec3(1),
                           double degrees = 0) {
      glm::dmat4 m = glm::translate(glm::dmat4(1), offset + position);
      m = glm::rotate(m, glm::radians(degrees), dvec3(0.3, 0.9, 0.1));
      add_instance(scene, name, mesh, glm::scale(m, scale));
      return int(scene.instances.size()) - 1;
    };
    Mesh floor, wall, sphere, block, leaves, sheet;
    shapes::add_quad(floor, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 13, 11);
    shapes::add_quad(wall, {-4, 0, 0}, {8, 0, 0}, {0, 4, 0});
    shapes::add_sphere(sphere, {0, 0, 0}, 0.6f, 5);
    shapes::add_box(block, {-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
    shapes::add_quad(leaves, {-1, 0, 0}, {2, 0, 0}, {0, 1.5f, 0}, 3, 2);
    shapes::add_quad(sheet, {-0.8f, 0, -0.8f}, {1.6f, 0, 0}, {0, 0.2f, 1.6f}, 4, 4);
    place("floor", add_mesh(scene, shapes::finished(std::move(floor), "floor", plaster)), {0, 0, 0});
    const int walls = add_mesh(scene, shapes::finished(std::move(wall), "wall", plaster));
    place("back", walls, {0, 0, -4});
    const int balls = add_mesh(scene, shapes::finished(std::move(sphere), "sphere", plaster));
    ball = place("ball", balls, {-1.5, 0.7, -1});
    place("ball at rest", balls, {2, 0.6, -2}, dvec3(0.8, 1.3, 0.8), 30);
    mirrored = place("mirrored", balls, {0.5, 1.2, -2.2}, dvec3(-0.9, 0.5, 1.4), 50);
    box = place("box", add_mesh(scene, shapes::finished(std::move(block), "block", plaster)), {1, 0.5, 0.4},
                dvec3(1, 1, 0.6), 20);
    hedge = place("hedge", add_mesh(scene, shapes::finished(std::move(leaves), "leaves", leaf)), {-2, 0, 1});
    cloth_mesh = add_mesh(scene, shapes::finished(std::move(sheet), "sheet", plaster));
    cloth = place("cloth", cloth_mesh, {0, 2, -1});
    for (int i = 0; i < 8; ++i)
      add_point(scene, "lamp", {0, 0, 0}, {1, 0.9f, 0.8f}, 3, 2.5f + 0.4f * float(i));
    add_spot(scene, "torch", {0, 0, 0}, {0, -1, -0.2f}, {1, 1, 1}, 9, 6, 15, 35);
    add_spot(scene, "torch", {0, 0, 0}, {0.5f, -1, 0}, {1, 1, 1}, 9, 6, 10, 25);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      scene.lights[i].position =
          offset + dvec3(-3 + 0.65 * double(i), 1.2 + 0.8 * double(i % 3), 1.5 - 0.9 * double(i % 5));
      scene.lights[i].casts_shadow = true;
    }
  }

  void add_sun() {
    sun = int(scene.lights.size());
    Light& light = scene.lights.emplace_back();
    light.type = LightType::directional, light.direction = glm::normalize(glm::vec3(0.3f, -1, -0.4f)),
    light.intensity = 1;
    light.casts_shadow = true;
  }

  View view(double turn, int width, int height) const {
    const dvec3 eye = offset + dvec3(3 * std::sin(turn), 1.7, 3.6 * std::cos(turn) + 0.4);
    const Camera camera = look_at(eye, offset + dvec3(0, 0.8, -1));
    return make_view(camera, width, height);
  }

  // Moves some objects in a frame; in some frames nothing moves.
  SceneChanges move(int frame) {
    SceneChanges changes;
    const double t = frame * 0.1;
    const auto turn = [&](int instance, double degrees, dvec3 by) {
      glm::dmat4& m = scene.instances[size_t(instance)].world_from_object;
      m = glm::translate(glm::dmat4(1), by) * m *
          glm::rotate(glm::dmat4(1), glm::radians(degrees), dvec3(0, 1, 0));
      changes.instances.push_back(instance);
    };
    if (frame % 7 == 3) turn(ball, 5, {0.1 * std::cos(t), 0, 0.05 * std::sin(t)});
    if (frame % 11 == 5) turn(box, 17, {0, 0, 0});
    if (frame % 13 == 2) turn(mirrored, 9, {0, 0.1 * std::sin(t), 0});
    if (frame % 17 == 8) turn(hedge, 21, {0.05, 0, 0});
    if (frame % 5 == 1) {
      const size_t light = size_t(frame / 5) % scene.lights.size();
      scene.lights[light].position += dvec3(0.2 * std::sin(t), 0.1 * std::cos(t), 0.1 * std::cos(2 * t));
      changes.lights.push_back(int(light));
    }
    if (frame % 19 == 7) {
      Light& torch = scene.lights[8 + size_t(frame / 19) % 2];
      torch.direction = glm::normalize(dvec3(std::sin(t), -1.5, std::cos(3 * t)));
      changes.lights.push_back(8 + frame / 19 % 2);
    }
    if (sun >= 0 && frame % 9 == 6) {
      scene.lights[size_t(sun)].direction = glm::normalize(glm::vec3(0.3 * std::cos(t), -1, -0.4));
      changes.lights.push_back(sun);
    }
    if (frame % 23 == 4) {
      Mesh& mesh = scene.meshes[size_t(cloth_mesh)];
      for (glm::vec3& p : mesh.positions) p.y = 0.3f * std::sin(float(t) + 2 * p.x + p.z);
      mesh = shapes::finished(std::move(mesh), "sheet", mesh.material);
      changes.meshes.push_back(cloth_mesh);
    }
    return changes;
  }
};

struct Case {
  const char *technique = "visibility", *shadows = "exact";
  dvec3 offset{0};
  int frames = 20, width = 200, height = 120;
  bool is_hedge_blended = false;
  bool still = false;                                       // the camera; there is a sun, too
  std::vector<const char*> settings = {"shadow-reuse=on"};  // of what is kept
  std::vector<const char*> common = {};                     // of both
};

struct Sum {
  size_t rays = 0, rays_without = 0, kept = 0, hidden = 0, drawn = 0, maps = 0;
};

// Frame by frame against a run that keeps nothing, whose rays take the tree.
Sum expect_same_bits(Renderer& devices, const Case& c) {
  MovingRoom room(c.offset);
  if (c.still) room.add_sun();
  if (c.is_hedge_blended) room.scene.materials[size_t(room.leaf)].alpha_mode = AlphaMode::blend;
  GpuScene gpu(devices, room.scene);
  Settings settings;
  apply_setting(settings, std::string("shadows=") + c.shadows);
  apply_setting(settings, "shadow-cells=off");
  for (const char* setting : c.common) apply_setting(settings, setting);
  const View start = room.view(0, c.width, c.height);
  TechniqueRun without(devices, gpu, start, settings, find_technique(c.technique));
  apply_setting(settings, "shadow-cells=on");
  for (const char* setting : c.settings) apply_setting(settings, setting);
  TechniqueRun with(devices, gpu, start, settings, find_technique(c.technique));
  Sum sum;
  double turn = 0;
  for (int frame = 0; frame < c.frames; ++frame) {
    const SceneChanges changes = room.move(frame);
    if (!changes.empty()) gpu.update(changes);
    if (frame % 3 != 0 && !c.still) turn += 0.02;
    const View view = room.view(turn, c.width, c.height);
    for (TechniqueRun* run : {&without, &with}) run->look(view, changes), run->run_frame();
    const HostShadows truth = without.frame().shadows(), bits = with.frame().shadows();
    EXPECT_EQ(bits.cells, truth.cells) << "frame " << frame;
    EXPECT_EQ(bits.indices, truth.indices) << "frame " << frame;
    EXPECT_EQ(bits.bits == truth.bits, true) << "frame " << frame;
    EXPECT_EQ(bits.shares == truth.shares, true) << "frame " << frame;
    EXPECT_TRUE(identical(with.image(), without.image())) << "frame " << frame;
    const ShadowFigures figures = with.frame().shadow_figures();
    sum.drawn += figures.drawn, sum.maps += figures.maps, sum.kept += figures.kept;
    sum.rays += figures.rays;
    sum.rays_without += without.frame().shadow_figures().rays;
    for (const uint32_t word : truth.bits) sum.hidden += size_t(__builtin_popcount(word));
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(sum.hidden, size_t(c.frames) * 100);
  return sum;
}

TEST(KeptShadows, AreThoseOfRaysWhateverMoves) {
  for (const char* technique : {"visibility", "deferred"}) {
    const Sum sum = expect_same_bits(test_devices(), {.technique = technique, .frames = 60, .still = true});
    EXPECT_LT(sum.rays, sum.rays_without) << "in some frames nothing moves";
  }
}

TEST(KeptShadows, AreThoseOfRaysFarFromTheOrigin) {
  const Sum sum = expect_same_bits(opencl_devices(), {.offset = {1e5, 300, -2e5}, .still = true});
  EXPECT_LT(sum.rays, sum.rays_without);
}

// Lists of lights at rest are kept, and others are made as lights and casters come to rest.
TEST(KeptShadows, AreThoseOfTheTreeWhereLightsHaveCells) {
  const int frames = long_tests() ? 300 : 40;
  expect_same_bits(opencl_devices(), {.frames = frames, .settings = {}});
  expect_same_bits(opencl_devices(), {.frames = frames, .settings = {"shadow-memory=1M"}});
  expect_same_bits(opencl_devices(), {.offset = {1e5, 300, -2e5}, .frames = frames, .settings = {}});
}

// At edges, where rays are traced as surfaces are shaded; where blended surfaces cast; and where rays are
// picked. With shadow-reuse=on lists may change while the bits are kept.
TEST(KeptShadows, AreThoseOfTheTreeInEachKindOfShadow) {
  const int frames = long_tests() ? 300 : 25;
  for (const char* reuse : {"shadow-reuse=off", "shadow-reuse=on"}) {
    expect_same_bits(opencl_devices(), {.frames = frames,
                                        .is_hedge_blended = true,
                                        .settings = {reuse},
                                        .common = {"samples=4", "shadow-blended=alpha"}});
    expect_same_bits(opencl_devices(), {.frames = frames, .settings = {reuse}, .common = {"shadow-pick=4"}});
  }
}

TEST(KeptShadows, AreThoseOfMapsDrawnAnewInEachFrame) {
  for (const bool at_rest : {false, true}) {
    const Sum sum = expect_same_bits(opencl_devices(),
                                     {.shadows = "map", .frames = long_tests() ? 300 : 30, .still = at_rest});
    EXPECT_EQ(sum.maps, sum.drawn + sum.kept);
    EXPECT_LT(sum.drawn, sum.maps / 2);
    EXPECT_GT(sum.drawn, sum.maps / 20);
  }
}

}  // namespace
}  // namespace lightgrid
