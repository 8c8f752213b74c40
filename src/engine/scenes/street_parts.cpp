// Road, pavements, houses with their shops, lamp posts, garlands and cars.
#include "scenes/street_parts.h"

#include <algorithm>

#include "scenes/shapes.h"

namespace lightgrid::street {
namespace {

using namespace shapes;

constexpr float half = house_m / 2, shop_top_m = 3, storey_m = 3.1f, first_storey_m = 4.4f, reveal_m = 0.22f;
constexpr float shop_z0 = -3.4f, shop_z1 = 2.5f, door_z0 = 3.1f, door_z1 = 4.1f, shop_depth_m = 3,
                sill_m = 0.5f;

// Facing -x at `x`.
void add_panel(Mesh& mesh, float x, const Rectangle& r) {
  const std::vector<glm::vec3> lower = {{x, r.y0, r.z0}, {x, r.y0, r.z1}},
                               upper = {{x, r.y1, r.z0}, {x, r.y1, r.z1}};
  add_strip(mesh, lower, upper, {-1, 0, 0}, {0, 0, 1});
}

// The four sides of a hole from the front back into the wall.
void add_hole(Mesh& mesh, const Rectangle& r, float depth) {
  const glm::vec3 back(depth, 0, 0), up(0, r.y1 - r.y0, 0), along(0, 0, r.z1 - r.z0),
      corner(front_x_m, r.y0, r.z0);
  add_quad(mesh, corner, back, up);
  add_quad(mesh, corner + along + back, -back, up);
  add_quad(mesh, corner, along, back);
  add_quad(mesh, corner + up + back, along, -back);
}

int storeys(int kind) { return 2 + kind % 2; }

}  // namespace

std::vector<Rectangle> windows(int kind) {
  std::vector<Rectangle> all;
  for (int storey = 0; storey < storeys(kind); ++storey) {
    const float y = first_storey_m + storey_m * storey;
    for (const float z : {-2.9f, 0.f, 2.9f}) all.push_back({z - 0.6f, z + 0.6f, y, y + 1.9f});
  }
  return all;
}

float height_m(int kind) { return first_storey_m + storey_m * storeys(kind) + 0.4f; }

namespace {

Mesh facade(int kind, int material) {
  Mesh mesh;
  const Rectangle shop{shop_z0, shop_z1, sill_m, shop_top_m}, door{door_z0, door_z1, 0, shop_top_m};
  add_panel(mesh, front_x_m, {-half, shop_z0, 0, shop_top_m});
  add_panel(mesh, front_x_m, {shop_z1, door_z0, 0, shop_top_m});
  add_panel(mesh, front_x_m, {door_z1, half, 0, shop_top_m});
  add_panel(mesh, front_x_m, {-half, half, shop_top_m, first_storey_m});
  add_hole(mesh, shop, reveal_m);
  add_hole(mesh, door, reveal_m);
  const auto holes = windows(kind);
  for (size_t i = 0; i < holes.size(); i += 3) {
    const float y0 = holes[i].y0, y1 = holes[i].y1,
                next = i + 3 < holes.size() ? holes[i + 3].y0 : height_m(kind);
    float z = -half;
    for (size_t k = i; k < i + 3; ++k) {
      add_panel(mesh, front_x_m, {z, holes[k].z0, y0, y1});
      add_hole(mesh, holes[k], reveal_m);
      z = holes[k].z1;
    }
    add_panel(mesh, front_x_m, {z, half, y0, y1});
    add_panel(mesh, front_x_m, {-half, half, y1, next});
  }
  return finished(std::move(mesh), "facade", material);
}

// One window in three, or the other two, has light behind it.
std::vector<Mesh> window_meshes(const char* name, int material, bool lit) {
  std::vector<Mesh> meshes;
  for (int kind = 0; kind < 2; ++kind) {
    for (int pattern = 0; pattern < 2; ++pattern) {
      Mesh mesh;
      const auto all = windows(kind);
      for (size_t i = 0; i < all.size(); ++i) {
        const bool has_light = pattern == 0 ? (i * 2 + i / 3) % 3 == 0 : (i + i / 3) % 2 == 0;
        if (has_light == lit) add_panel(mesh, front_x_m + reveal_m, all[i]);
      }
      meshes.push_back(finished(std::move(mesh), name, material));
    }
  }
  return meshes;
}

}  // namespace

Mesh road(const Materials& m) {
  Mesh mesh;
  add_quad(mesh, {-kerb_x_m, 0, 8}, {2 * kerb_x_m, 0, 0}, {0, 0, -length_m - 8}, 4, 92);
  return finished(std::move(mesh), "road", m.asphalt);
}

Mesh pavements(const Materials& m) {
  Mesh mesh;
  for (int i = 0; i < 23; ++i) {
    const float z = 8 - 16.f * i;
    add_box(mesh, {-front_x_m, -0.1f, z - 16}, {-kerb_x_m, 0.14f, z});
    add_box(mesh, {kerb_x_m, -0.1f, z - 16}, {front_x_m, 0.14f, z});
  }
  return finished(std::move(mesh), "pavements", m.paving);
}

Mesh markings(const Materials& m) {
  Mesh mesh;
  for (int i = 0; i < 60; ++i) add_box(mesh, {-0.07f, 0, -6.f * i - 3}, {0.07f, 0.01f, -6.f * i});
  return finished(std::move(mesh), "road markings", m.marking);
}

std::vector<Mesh> facades(const Materials& m) {
  std::vector<Mesh> meshes;
  for (int kind = 0; kind < 4; ++kind) meshes.push_back(facade(kind, m.walls[kind]));
  return meshes;
}

std::vector<Mesh> lit_windows(const Materials& m) { return window_meshes("lit windows", m.lit_window, true); }
std::vector<Mesh> dark_windows(const Materials& m) {
  return window_meshes("dark windows", m.dark_window, false);
}

std::vector<Mesh> house_trims(const Materials& m) {
  std::vector<Mesh> meshes;
  for (int kind = 0; kind < 2; ++kind) {
    Mesh mesh;
    const float x = front_x_m, top = height_m(kind);
    add_box(mesh, {x - 0.35f, top, -half}, {x + 0.5f, top + 0.35f, half});
    add_box(mesh, {x - 0.12f, first_storey_m - 0.4f, -half}, {x + 0.1f, first_storey_m - 0.2f, half});
    add_box(mesh, {x - 0.06f, 0, shop_z0}, {x + reveal_m, sill_m, shop_z1});
    for (const Rectangle& w : windows(kind)) {
      add_box(mesh, {x - 0.1f, w.y0 - 0.12f, w.z0 - 0.12f}, {x + reveal_m, w.y0, w.z1 + 0.12f});
      add_box(mesh, {x + 0.14f, w.y0, (w.z0 + w.z1) / 2 - 0.03f},
              {x + reveal_m + 0.01f, w.y1, (w.z0 + w.z1) / 2 + 0.03f});
    }
    meshes.push_back(finished(std::move(mesh), "house trim", m.trim));
  }
  return meshes;
}

Mesh shop_inside(const Materials& m) {
  Mesh mesh;
  const float x0 = front_x_m + reveal_m, x1 = front_x_m + shop_depth_m, deep = x1 - x0;
  add_panel(mesh, x1, {shop_z0, shop_z1, 0, shop_top_m});
  add_quad(mesh, {x0, 0.3f, shop_z0}, {0, 0, shop_z1 - shop_z0}, {deep, 0, 0});
  add_quad(mesh, {x1, shop_top_m, shop_z0}, {0, 0, shop_z1 - shop_z0}, {-deep, 0, 0});
  add_quad(mesh, {x0, 0, shop_z0}, {deep, 0, 0}, {0, shop_top_m, 0});
  add_quad(mesh, {x1, 0, shop_z1}, {-deep, 0, 0}, {0, shop_top_m, 0});
  // Shelves along the back, goods in the window.
  for (const float y : {0.9f, 1.4f, 1.9f, 2.4f})
    add_box(mesh, {x1 - 0.4f, y, shop_z0 + 0.2f}, {x1 - 0.05f, y + 0.05f, shop_z1 - 0.2f});
  for (int i = 0; i < 6; ++i) {
    const float z = shop_z0 + 0.6f + 0.95f * i, size = 0.18f + 0.05f * ((i * 5) % 4);
    add_box(mesh, {x0 + 0.35f, 0.3f, z - size}, {x0 + 0.35f + 2 * size, 0.62f + 2.5f * size, z + size});
  }
  add_panel(mesh, front_x_m + reveal_m, {door_z0, door_z1, 0, shop_top_m});
  return finished(std::move(mesh), "shop inside", m.interior);
}

Mesh shop_window(const Materials& m) {
  Mesh mesh;
  add_panel(mesh, front_x_m + 0.1f, {shop_z0, shop_z1, sill_m, shop_top_m});
  return finished(std::move(mesh), "shop window", m.glass);
}

std::vector<Mesh> sign_meshes(const Materials& m) {
  std::vector<Mesh> meshes;
  for (const int neon : m.neon) {
    Mesh mesh;
    add_box(mesh, {front_x_m - 0.12f, 3.3f, -2.6f}, {front_x_m - 0.02f, 3.36f, 1.8f});
    add_box(mesh, {front_x_m - 0.12f, 3.72f, -2.6f}, {front_x_m - 0.02f, 3.78f, 1.8f});
    // Letters without meaning.
    for (int i = 0; i < 8; ++i) {
      const float z = -2.3f + 0.5f * i;
      add_box(mesh, {front_x_m - 0.1f, 3.42f, z},
              {front_x_m - 0.03f, 3.66f, z + (i % 3 == 1 ? 0.08f : 0.3f)});
    }
    // A blade sign at right angles to the front.
    add_box(mesh, {front_x_m - 0.65f, 4.5f, 4.15f}, {front_x_m - 0.15f, 5.5f, 4.21f});
    meshes.push_back(finished(std::move(mesh), "sign", neon));
  }
  return meshes;
}

namespace {

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
