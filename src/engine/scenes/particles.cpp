// A yard at night full of smoke: puffs that face the first camera, lit by the sparks that rise in them. Many
// blended layers over a pixel, each lit; what Halo Wars filled its voxel light buffer for
// (docs/techniques/voxel_lights.md).
#include <algorithm>
#include <cmath>

#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/patterns.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

constexpr int fires = 5, puffs_of_fire = 48, sparks_of_fire = 64, mist_puffs = 60, pillars = 12;
constexpr float yard_m = 36;
const glm::dvec3 front_eye{0, 3.4, 15.5};

// Square, its edges clear.
Bitmap puff_bitmap() {
  constexpr int size = 64;
  const patterns::Field ragged = patterns::noise(size, 4, 4, 3, 907);
  return patterns::color_bitmap("puff", size, [&](int x, int y) {
    const float u = (float(x) + 0.5f) / size * 2 - 1, v = (float(y) + 0.5f) / size * 2 - 1;
    const float inside = std::max(1 - std::sqrt(u * u + v * v) - 0.35f * (ragged.at(x, y) - 0.5f), 0.f);
    const float at_edge = patterns::step_between(0, 0.12f, 1 - std::max(std::abs(u), std::abs(v)));
    return glm::vec4(1, 1, 1, std::min(1.6f * inside, 1.f) * at_edge);
  });
}

// Two metres a side, towards z. Its normals spread, so that light wraps around it as around a ball.
Mesh puff_mesh(const std::string& name, int material) {
  constexpr int puff_cells = 2;
  std::vector<shapes::SurfacePoint> points;
  for (int row = 0; row <= puff_cells; ++row) {
    for (int column = 0; column <= puff_cells; ++column) {
      const float x = 2.f * float(column) / puff_cells - 1, y = 2.f * float(row) / puff_cells - 1;
      points.push_back({{x, y, 0},
                        glm::normalize(glm::vec3(0.8f * x, 0.8f * y, 1)),
                        {1, 0, 0},
                        {0.5f + 0.5f * x, 0.5f - 0.5f * y}});
    }
  }
  Mesh mesh;
  shapes::add_grid(mesh, puff_cells, puff_cells, points);
  return shapes::finished(std::move(mesh), name, material);
}

glm::dmat4 facing_front(glm::dvec3 center, double size, double roll_rad) {
  const glm::dvec3 back = glm::normalize(front_eye - center),
                   across = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
  const glm::dvec3 up = glm::cross(back, across);
  const glm::dvec3 x = across * std::cos(roll_rad) + up * std::sin(roll_rad), y = glm::cross(back, x);
  return glm::dmat4(glm::dvec4(x * size, 0), glm::dvec4(y * size, 0), glm::dvec4(back * size, 0),
                    glm::dvec4(center, 1));
}

int add_puff_material(Scene& scene, const std::string& name, glm::vec3 color, float alpha, int texture) {
  const int index = add_material(scene, name, color, 0, 1);
  Material& m = scene.materials[index];
  m.base_color.a = alpha;
  m.alpha_mode = AlphaMode::blend;
  m.base_color_map.texture = texture;
  return index;
}

void add_yard(Scene& scene) {
  const int stone = add_material(scene, "flagstones", {0.42f, 0.40f, 0.38f}, 0, 0.65f);
  Mesh floor;
  shapes::add_quad(floor, {-yard_m / 2, 0, yard_m / 2}, {yard_m, 0, 0}, {0, 0, -yard_m}, 24, 24);
  add_instance(scene, "floor", add_mesh(scene, shapes::finished(std::move(floor), "floor", stone)));
  const int plaster = add_material(scene, "plaster", {0.62f, 0.55f, 0.46f}, 0, 0.85f);
  Mesh pillar;
  shapes::add_box(pillar, {-0.45f, 0, -0.45f}, {0.45f, 5.2f, 0.45f});
  shapes::add_box(pillar, {-0.65f, 5.2f, -0.65f}, {0.65f, 5.6f, 0.65f});
  const int pillar_mesh = add_mesh(scene, shapes::finished(std::move(pillar), "pillar", plaster));
  for (int i = 0; i < pillars; ++i) {
    const float x = (i % 2 ? 1.f : -1.f) * 8.5f, z = 9.f - 4.2f * float(i / 2);
    add_instance(scene, "pillar " + std::to_string(i), pillar_mesh, placed({x, 0, z}));
    add_spot(scene, "lantern " + std::to_string(i), {x * 0.9f, 4.8f, z}, {x * 0.35f, 0, z - 0.5f},
             {1, 0.85f, 0.6f}, 14, 9, 18, 34);
  }
}

void add_fires(Scene& scene, Random& random, int puff) {
  const int iron = add_material(scene, "iron", {0.35f, 0.33f, 0.32f}, 1, 0.45f);
  Mesh bowl;
  const glm::vec2 profile[] = {{0.12f, 0}, {0.18f, 0.4f}, {0.55f, 0.75f}, {0.6f, 0.85f}};
  shapes::add_lathe(bowl, {0, 0, 0}, profile, 16);
  const int bowl_mesh = add_mesh(scene, shapes::finished(std::move(bowl), "bowl", iron));
  static constexpr glm::vec3 hues[fires] = {
      {1, 0.55f, 0.22f}, {1, 0.42f, 0.30f}, {0.45f, 0.75f, 1}, {0.95f, 0.8f, 0.35f}, {0.65f, 0.45f, 1}};
  static constexpr glm::vec2 places[fires] = {
      {-4.5f, 5}, {4, 3.5f}, {-0.3f, -1.5f}, {-5.5f, -7}, {5.5f, -8.5f}};
  for (int fire = 0; fire < fires; ++fire) {
    const glm::vec3 at(places[fire].x, 0, places[fire].y);
    const std::string number = std::to_string(fire);
    add_instance(scene, "bowl " + number, bowl_mesh, placed(at));
    add_point(scene, "fire " + number, at + glm::vec3(0, 1.3f, 0), hues[fire], 5, 7);
    for (int i = 0; i < puffs_of_fire; ++i) {
      // Rises, spreads, drifts to one side.
      const float t = (float(i) + random.uniform()) / puffs_of_fire, spread = 0.15f + 0.9f * t;
      const glm::vec3 center = at + glm::vec3(random.uniform(-spread, spread) + 1.4f * t * t, 1.1f + 5.5f * t,
                                              random.uniform(-spread, spread));
      add_instance(scene, "puff " + number + "." + std::to_string(i), puff,
                   facing_front(center, 0.3 + 0.8 * t, 6.28 * random.uniform()));
    }
    for (int i = 0; i < sparks_of_fire; ++i) {
      const float t = random.uniform(), spread = 0.3f + 1.3f * t;
      const glm::vec3 center = at + glm::vec3(random.uniform(-spread, spread) + 1.4f * t * t, 0.9f + 5.5f * t,
                                              random.uniform(-spread, spread));
      const float radius = random.uniform(0.8f, 1.8f);
      const glm::vec3 color = glm::mix(hues[fire], glm::vec3(1, 0.9f, 0.75f), random.uniform(0, 0.5f));
      add_point(scene, "spark " + number + "." + std::to_string(i), center, color, 0.12f * radius * radius,
                radius);
    }
  }
}

void add_mist(Scene& scene, Random& random, int puff) {
  for (int i = 0; i < mist_puffs; ++i) {
    const glm::dvec3 center(random.uniform(-11, 11), random.uniform(0.5f, 1.1f), random.uniform(-15, 9));
    add_instance(scene, "mist " + std::to_string(i), puff,
                 facing_front(center, random.uniform(1, 1.8f), 6.28 * random.uniform()));
  }
}

}  // namespace

Scene make_particles() {
  Scene scene;
  scene.name = "particles";
  scene.ambient = glm::vec3(0.03f, 0.035f, 0.05f);
  scene.background = glm::vec3(0.006f, 0.008f, 0.016f);
  Random random(11);
  add_yard(scene);
  const int texture = add_texture(scene, puff_bitmap(), true);
  const int smoke = add_puff_material(scene, "smoke", {0.75f, 0.73f, 0.72f}, 0.35f, texture);
  const int mist = add_puff_material(scene, "mist", {0.8f, 0.85f, 0.9f}, 0.14f, texture);
  add_fires(scene, random, add_mesh(scene, puff_mesh("smoke", smoke)));
  add_mist(scene, random, add_mesh(scene, puff_mesh("mist", mist)));
  add_camera(scene, "front", front_eye, {0, 2.2, 0}, 58);
  add_camera(scene, "smoke", {-1.5, 2.6, 7.5}, {-4, 2.8, 3}, 60);
  return scene;
}

}  // namespace lightgrid
