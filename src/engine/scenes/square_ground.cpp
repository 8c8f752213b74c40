// The ground of the square, and its houses besides what the street's have.
#include <algorithm>
#include <cmath>

#include "scene/random.h"
#include "scenes/shapes.h"
#include "scenes/square_parts.h"

namespace lightgrid::square {
namespace {

using namespace shapes;

constexpr float back_x_m = street::front_x_m + 8, half = street::house_m / 2;

// From above the front to above the back.
std::vector<glm::vec3> roof_line(int kind, float z) {
  const float y = street::height_m(kind), x = street::front_x_m;
  return {{x, y, z},
          {x + 1.2f, y + 2.6f, z},
          {x + 4, y + 3.3f, z},
          {back_x_m - 1.2f, y + 2.6f, z},
          {back_x_m, y, z}};
}

}  // namespace

Mesh setts(const Materials& m) {
  Mesh mesh;
  Random random(89);
  constexpr int count = 12;
  constexpr float size = patch_m / count;
  // Four points an edge: a joint at both ends, a rounded top between.
  constexpr float inset[] = {0, 0.14f, 0.86f, 1}, slope[] = {-0.55f, -0.3f, 0.3f, 0.55f};
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count; ++column) {
      const float top = random.uniform(-0.006f, 0.006f);
      std::vector<SurfacePoint> points;
      for (int j = 3; j >= 0; --j) {
        for (int i = 0; i < 4; ++i) {
          const bool joint = i % 3 == 0 || j % 3 == 0;
          const glm::vec3 p((column + inset[i]) * size, joint ? -0.022f : top, (row + inset[j]) * size);
          points.push_back({p, {slope[i], 1, slope[j]}, {1, 0, 0}, {p.x, p.z}});
        }
      }
      add_grid(mesh, 3, 3, points);
    }
  }
  return finished(std::move(mesh), "setts", m.setts);
}

Mesh flat_setts(const Materials& m, int patches_x, int patches_z) {
  Mesh mesh;
  add_quad(mesh, {0, -0.006f, patches_z * patch_m}, {patches_x * patch_m, 0, 0}, {0, 0, -patches_z * patch_m},
           patches_x, patches_z);
  return finished(std::move(mesh), "flat setts", m.setts);
}

Mesh kerb(const Materials& m) {
  Mesh mesh;
  const glm::vec3 outline[] = {{-0.12f, -0.1f, 0.595f},
                               {-0.12f, 0.12f, 0.595f},
                               {-0.1f, 0.145f, 0.595f},
                               {0.12f, 0.145f, 0.595f},
                               {0.12f, -0.1f, 0.595f}};
  add_sweep(mesh, outline, {0, 0, -1.19f}, false);
  return finished(std::move(mesh), "kerb", m.kerb);
}

Mesh body(const street::Materials& m, int kind) {
  Mesh mesh;
  const float x = street::front_x_m, deep = back_x_m - x, high = street::height_m(kind);
  add_quad(mesh, {x, 0, half}, {deep, 0, 0}, {0, high, 0});
  add_quad(mesh, {back_x_m, 0, -half}, {-deep, 0, 0}, {0, high, 0});
  add_quad(mesh, {back_x_m, 0, half}, {0, 0, -2 * half}, {0, high, 0});
  for (const float side : {-1.f, 1.f}) {
    std::vector<glm::vec3> upper = roof_line(kind, side * half), lower = upper;
    for (glm::vec3& p : lower) p.y = high;
    if (side < 0) {
      std::reverse(upper.begin(), upper.end());
      std::reverse(lower.begin(), lower.end());
    }
    add_strip(mesh, lower, upper, {0, 0, side}, {side, 0, 0});
  }
  return finished(std::move(mesh), "house body", m.walls[kind]);
}

Mesh roof(const Materials& m, int kind) {
  Mesh mesh;
  add_sweep(mesh, roof_line(kind, half), {0, 0, -2 * half}, false);
  const float y = street::height_m(kind), x = street::front_x_m;
  for (const float z : {-2.9f, 0.f, 2.9f}) {
    add_box(mesh, {x + 0.25f, y + 1.75f, z - 0.75f}, {x + 2, y + 1.95f, z + 0.75f});
    for (const float side : {-0.68f, 0.6f})
      add_box(mesh, {x + 0.35f, y + 0.3f, z + side}, {x + 2, y + 1.8f, z + side + 0.08f});
  }
  return finished(std::move(mesh), "roof", m.slate);
}

Mesh chimneys(const street::Materials& m, int kind) {
  Mesh mesh;
  const float y = street::height_m(kind), x = street::front_x_m;
  add_box(mesh, {x + 3, y + 2, half - 0.7f}, {x + 5, y + 4.6f, half - 0.05f});
  for (int i = 0; i < 4; ++i) {
    const glm::vec2 pot[] = {{0.14f, 0}, {0.11f, 0.5f}, {0.13f, 0.55f}, {0.13f, 0.55f}, {0, 0.55f}};
    add_lathe(mesh, {x + 3.3f + 0.46f * i, y + 4.6f, half - 0.37f}, pot, 10);
  }
  return finished(std::move(mesh), "chimneys", m.walls[0]);
}

Mesh railing(const street::Materials& m, bool fine) {
  Mesh mesh;
  const float x = street::front_x_m - 0.16f;
  for (const float y : {0.08f, 0.78f, 0.9f})
    add_box(mesh, {x - 0.02f, y, -0.68f}, {x + 0.02f, y + 0.025f, 0.68f});
  for (int i = 0; i <= 10; ++i) {
    const float z = -0.66f + 0.132f * i;
    const glm::vec3 bar[] = {{x, 0.1f, z}, {x, 0.45f, z}, {x, 0.78f, z}};
    add_tube(mesh, bar, 0.009f, fine ? 6 : 4);
  }
  for (int i = 0; fine && i < 5; ++i) {
    const float z = -0.528f + 0.264f * i;
    add_torus(mesh, {x, 0.62f, z}, {1, 0, 0}, 0.058f, 0.008f, 12, 4);
    add_torus(mesh, {x, 0.24f, z}, {1, 0, 0}, 0.058f, 0.008f, 12, 4);
  }
  return finished(std::move(mesh), "railing", m.iron);
}

std::vector<glm::vec3> sagging(glm::vec3 from, glm::vec3 to, float sag_m, int segments) {
  std::vector<glm::vec3> line;
  for (int i = 0; i <= segments; ++i) {
    const float t = float(i) / segments;
    line.push_back(glm::mix(from, to, t) - glm::vec3(0, 4 * sag_m * t * (1 - t), 0));
  }
  return line;
}

}  // namespace lightgrid::square
