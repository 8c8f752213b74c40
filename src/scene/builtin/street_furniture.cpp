// Lamp posts, garlands and cars.
#include <algorithm>

#include "scene/builtin/shapes.h"
#include "scene/builtin/street_parts.h"

namespace lightgrid::street {
namespace {

using namespace shapes;

// Extrudes a side view (z, height), from the back (+z) over the top to the front, by `half_width` both ways;
// open below.
void add_prism(Mesh& mesh, std::span<const glm::vec2> outline, float half_width, bool sides) {
  std::vector<glm::vec3> right_top, right_bottom, left_top, left_bottom;
  for (const glm::vec2& p : outline) {
    right_top.emplace_back(half_width, p.y, p.x);
    right_bottom.emplace_back(half_width, outline.front().y, p.x);
    left_top.emplace(left_top.begin(), -half_width, p.y, p.x);
    left_bottom.emplace(left_bottom.begin(), -half_width, outline.front().y, p.x);
  }
  add_sweep(mesh, right_top, {-2 * half_width, 0, 0}, false);
  if (!sides) return;
  add_strip(mesh, right_bottom, right_top, {1, 0, 0}, {0, 0, -1});
  add_strip(mesh, left_bottom, left_top, {-1, 0, 0}, {0, 0, 1});
}

}  // namespace

Mesh lamp_post(const Materials& m) {
  Mesh mesh;
  const std::vector<glm::vec2> pole = {{0.16f, 0},     {0.16f, 0.5f}, {0.16f, 0.5f},
                                       {0.09f, 0.62f}, {0.06f, 1.2f}, {0.045f, 5.8f}};
  add_lathe(mesh, glm::vec3(0), pole, 12);
  add_box(mesh, {-1.3f, 5.74f, -0.035f}, {0.05f, 5.81f, 0.035f});
  add_box(mesh, {-1.4f, 5.72f, -0.15f}, {-0.8f, 5.82f, 0.15f});
  return finished(std::move(mesh), "lamp post", m.iron);
}

Mesh lamp_head(const Materials& m) {
  Mesh mesh;
  add_box(mesh, {-0.26f, 0.03f, -0.12f}, {0.26f, 0.13f, 0.12f});
  return finished(std::move(mesh), "lamp", m.warm_lamp);
}

std::vector<Mesh> bulb_meshes(const Materials& m) {
  std::vector<Mesh> meshes;
  for (const int neon : m.neon) {
    Mesh mesh;
    add_sphere(mesh, glm::vec3(0), 0.09f, 2);
    meshes.push_back(finished(std::move(mesh), "bulb", neon));
  }
  return meshes;
}

Mesh garland_wire(const Materials& m) {
  std::vector<glm::vec3> line;
  for (int i = -12; i <= 12; ++i)
    line.emplace_back(front_x_m * i / 12.f, garland_height_m(i / 12.f), -0.012f);
  Mesh mesh;
  add_sweep(mesh, line, {0, 0.024f, 0}, true);
  std::reverse(line.begin(), line.end());
  for (glm::vec3& p : line) p.z = 0.012f;
  add_sweep(mesh, line, {0, 0.024f, 0}, true);
  return finished(std::move(mesh), "garland wire", m.iron);
}

std::vector<Mesh> car_bodies(const Materials& m) {
  static constexpr glm::vec2 body[] = {{2.2f, 0.3f},   {2.2f, 0.9f},   {1.7f, 0.98f}, {-1.0f, 0.95f},
                                       {-2.0f, 0.82f}, {-2.15f, 0.6f}, {-2.15f, 0.3f}};
  std::vector<Mesh> meshes;
  for (const int paint : m.paints) {
    Mesh mesh;
    add_prism(mesh, body, 0.88f, true);
    add_box(mesh, {-0.7f, 1.42f, -0.15f}, {0.7f, 1.46f, 1.15f});
    for (const float x : {-0.72f, 0.68f}) {
      for (const float z : {-0.2f, 1.15f}) add_box(mesh, {x, 0.95f, z}, {x + 0.04f, 1.43f, z + 0.08f});
    }
    meshes.push_back(finished(std::move(mesh), "car", paint));
  }
  return meshes;
}

Mesh car_glass(const Materials& m) {
  static constexpr glm::vec2 cabin[] = {{1.65f, 0.95f}, {1.2f, 1.41f}, {-0.2f, 1.41f}, {-0.95f, 0.95f}};
  Mesh mesh;
  add_prism(mesh, cabin, 0.7f, true);
  return finished(std::move(mesh), "car windows", m.car_window);
}

Mesh car_wheels(const Materials& m) {
  Mesh mesh;
  for (const float x : {-0.8f, 0.8f}) {
    for (const float z : {-1.35f, 1.4f}) add_torus(mesh, {x, 0.32f, z}, {1, 0, 0}, 0.2f, 0.12f, 14, 5);
  }
  return finished(std::move(mesh), "wheels", m.tyre);
}

Mesh car_lamps(const Materials& m, bool head) {
  Mesh mesh;
  for (const float x : {-0.62f, 0.62f}) {
    if (head) add_box(mesh, {x - 0.14f, 0.56f, -2.16f}, {x + 0.14f, 0.70f, -2.0f});
    if (!head) add_box(mesh, {x - 0.18f, 0.66f, 2.1f}, {x + 0.18f, 0.78f, 2.25f});
  }
  return finished(std::move(mesh), head ? "head lamps" : "tail lamps", head ? m.head_lamp : m.tail_lamp);
}

}  // namespace lightgrid::street
