// The parts of one bay, then those that exist once: floor, vault and end walls. Walls have arched openings.
#include "scenes/hall_parts.h"
#include "scenes/shapes.h"

namespace lightgrid::hall {
namespace {

using namespace shapes;

// A wall with an arched opening, in the plane of `right` and `up` through `origin` (at the opening's middle).
struct ArchedWall {
  glm::vec3 origin, right, up;
  float half_width, bottom, top;
  float opening_half_width, sill, springing;
  int segments = 16;
};
constexpr float half = bay_m / 2, arch_radius = 1.45f;

std::vector<glm::vec3> opening_arc(const ArchedWall& w, glm::vec3 offset, float from, float to) {
  return arc(w.origin + offset + w.up * w.springing, w.right * w.opening_half_width,
             w.up * w.opening_half_width, from, to, w.segments);
}

glm::vec3 on(const ArchedWall& w, float across, float height) {
  return w.origin + w.right * across + w.up * height;
}

ArchedWall arcade(bool nave_face) {
  const float x = nave_face ? nave_half_width_m : nave_half_width_m + wall_m;
  return {{x, 0, 0},   {0, 0, nave_face ? 1.f : -1.f},
          {0, 1, 0},   half,
          springing_m, nave_face ? vault_springing_m : aisle_height_m,
          arch_radius, springing_m,
          springing_m};
}

ArchedWall niche() {
  return {{half_width_m, 0, 0}, {0, 0, 1}, {0, 1, 0}, half, 0, aisle_height_m, 0.9f, 0.7f, 2.5f};
}

void add_front(Mesh& mesh, const ArchedWall& w) {
  const glm::vec3 normal = glm::cross(w.right, w.up);
  const float a = w.opening_half_width;
  std::vector<glm::vec3> lower = {on(w, -w.half_width, w.springing)}, upper;
  const auto curve = opening_arc(w, glm::vec3(0), glm::pi<float>(), 0);
  lower.insert(lower.end(), curve.begin(), curve.end());
  lower.push_back(on(w, w.half_width, w.springing));
  for (const glm::vec3& p : lower) upper.push_back(p + w.up * (w.top - glm::dot(p - w.origin, w.up)));
  add_strip(mesh, lower, upper, normal, w.right);

  const auto add_panel = [&](float left, float right, float bottom, float top) {
    if (left >= right || bottom >= top) return;
    add_strip(mesh, std::vector{on(w, left, bottom), on(w, right, bottom)},
              std::vector{on(w, left, top), on(w, right, top)}, normal, w.right);
  };
  add_panel(-w.half_width, -a, w.bottom, w.springing);
  add_panel(a, w.half_width, w.bottom, w.springing);
  add_panel(-a, a, w.bottom, w.sill);
}

// The opening's sides, arch and sill.
void add_reveal(Mesh& mesh, const ArchedWall& w, float depth_m) {
  const float a = w.opening_half_width;
  const glm::vec3 inward = -glm::cross(w.right, w.up) * depth_m;
  add_sweep(mesh, opening_arc(w, glm::vec3(0), 0, glm::pi<float>()), inward, true);
  if (w.sill >= w.springing) return;
  const glm::vec3 height = w.up * (w.springing - w.sill);
  add_quad(mesh, on(w, a, w.sill) + inward, -inward, height);
  add_quad(mesh, on(w, -a, w.sill), inward, height);
  add_quad(mesh, on(w, -a, w.sill), w.right * (2 * a), inward);
}

// Closes the opening.
void add_back(Mesh& mesh, const ArchedWall& w, float depth_m) {
  const glm::vec3 normal = glm::cross(w.right, w.up);
  const std::vector<glm::vec3> upper = opening_arc(w, -normal * depth_m, glm::pi<float>(), 0);
  std::vector<glm::vec3> lower;
  for (const glm::vec3& p : upper) lower.push_back(p + w.up * (w.sill - glm::dot(p - w.origin, w.up)));
  add_strip(mesh, lower, upper, normal, w.right);
}

}  // namespace

Mesh bay_stone(const Materials& m) {
  Mesh mesh;
  add_front(mesh, arcade(true));
  add_front(mesh, arcade(false));
  add_front(mesh, niche());
  return finished(std::move(mesh), "bay walls", m.stone);
}

Mesh bay_brick(const Materials& m) {
  Mesh mesh;
  add_reveal(mesh, niche(), 0.8f);
  add_back(mesh, niche(), 0.8f);
  return finished(std::move(mesh), "niche", m.brick);
}

Mesh bay_trim(const Materials& m) {
  Mesh mesh;
  add_reveal(mesh, arcade(true), wall_m);
  // A moulding 8 cm proud of the wall around each arch and each niche.
  for (ArchedWall wall : {arcade(true), niche()}) {
    const glm::vec3 normal = glm::cross(wall.right, wall.up), proud = normal * 0.08f;
    ArchedWall outer = wall;
    outer.opening_half_width += 0.22f;
    const auto inner_arc = opening_arc(wall, proud, glm::pi<float>(), 0);
    const auto outer_arc = opening_arc(outer, proud, glm::pi<float>(), 0);
    add_strip(mesh, inner_arc, outer_arc, normal, wall.right);
    add_sweep(mesh, outer_arc, -proud, true);
    add_sweep(mesh, opening_arc(wall, proud, 0, glm::pi<float>()), -proud, true);
  }
  const float x = nave_half_width_m;
  const std::vector<glm::vec3> cornice = {{x, 6.42f, half},         {x - 0.12f, 6.5f, half},
                                          {x - 0.12f, 6.58f, half}, {x - 0.26f, 6.72f, half},
                                          {x - 0.26f, 6.8f, half},  {x, 6.8f, half}};
  add_sweep(mesh, cornice, {0, 0, -bay_m}, false);
  add_box(mesh, {half_width_m + 0.1f, 0.7f, -0.3f}, {half_width_m + 0.7f, 0.95f, 0.3f});
  return finished(std::move(mesh), "bay mouldings", m.trim);
}

Mesh bay_wood(const Materials& m) {
  const float inner = nave_half_width_m + wall_m, outer = half_width_m;
  Mesh mesh;
  add_quad(mesh, {inner, aisle_height_m, -half}, {outer - inner, 0, 0}, {0, 0, bay_m});
  for (const float z : {-1.25f, 0.f, 1.25f}) {
    add_box(mesh, {inner, aisle_height_m - 0.32f, z - 0.12f}, {outer, aisle_height_m - 0.01f, z + 0.12f});
  }
  return finished(std::move(mesh), "aisle ceiling", m.wood);
}

Mesh bay_tympanum(const Materials& m) {
  Mesh mesh;
  add_back(mesh, arcade(true), wall_m / 2);
  return finished(std::move(mesh), "stained glass", m.stained_glass);
}

Mesh bay_lattice(const Materials& m) {
  Mesh mesh;
  add_quad(mesh, {column_x_m, 0.15f, -1.5f}, {0, 0, 3}, {0, 2.1f, 0});
  return finished(std::move(mesh), "iron gate", m.lattice);
}

Mesh bay_lattice_frame(const Materials& m) {
  Mesh mesh;
  const float x = column_x_m;
  for (const float z : {-1.5f, 0.f, 1.5f})
    add_box(mesh, {x - 0.03f, 0, z - 0.03f}, {x + 0.03f, 2.4f, z + 0.03f});
  for (const float y : {0.12f, 2.25f}) add_box(mesh, {x - 0.025f, y, -1.5f}, {x + 0.025f, y + 0.05f, 1.5f});
  for (const float z : {-1.5f, 0.f, 1.5f}) add_sphere(mesh, {x, 2.46f, z}, 0.075f, 4);
  return finished(std::move(mesh), "gate frame", m.bronze);
}

Mesh bay_vitrine(const Materials& m) {
  Mesh mesh;
  add_back(mesh, niche(), 0.04f);
  return finished(std::move(mesh), "vitrine", m.clear_glass);
}

Mesh screen_glass(const Materials& m) {
  Mesh mesh;
  add_quad(mesh, {-0.7f, 0.12f, 0}, {1.4f, 0, 0}, {0, 2.2f, 0});
  return finished(std::move(mesh), "glass screen", m.stained_glass);
}

Mesh screen_frame(const Materials& m) {
  Mesh mesh;
  for (const float x : {-0.73f, 0.73f}) {
    add_box(mesh, {x - 0.03f, 0, -0.03f}, {x + 0.03f, 2.38f, 0.03f});
    add_box(mesh, {x - 0.05f, 0, -0.22f}, {x + 0.05f, 0.05f, 0.22f});
  }
  for (const float y : {0.07f, 2.32f}) add_box(mesh, {-0.7f, y, -0.025f}, {0.7f, y + 0.05f, 0.025f});
  return finished(std::move(mesh), "screen frame", m.gold);
}

namespace {

constexpr float dais_m = 0.6f;

ArchedWall apse_wall() {
  return {{0, 0, -half_length_m}, {1, 0, 0}, {0, 1, 0}, half_width_m, 0, 10, 2.1f, dais_m, 3.4f, 32};
}

ArchedWall entrance_wall() {
  return {{0, 0, half_length_m}, {-1, 0, 0}, {0, 1, 0}, half_width_m, 0, 10, 1.3f, 0, 2.4f, 24};
}

}  // namespace

Mesh floor_slab(const Materials& m) {
  Mesh mesh;
  add_quad(mesh, {-half_width_m, 0, half_length_m}, {2 * half_width_m, 0, 0}, {0, 0, -2 * half_length_m}, 8,
           20);
  return finished(std::move(mesh), "floor", m.floor);
}

Mesh carpet(const Materials& m) {
  Mesh mesh;
  add_box(mesh, {-1, 0, -11}, {1, 0.02f, 13});
  return finished(std::move(mesh), "carpet", m.carpet);
}

Mesh vault(const Materials& m) {
  Mesh mesh;
  const auto line = arc({0, vault_springing_m, half_length_m}, {nave_half_width_m, 0, 0},
                        {0, nave_half_width_m, 0}, 0, glm::pi<float>(), 48);
  for (int i = 0; i < bays; ++i) {
    auto moved = line;
    for (glm::vec3& p : moved) p.z -= i * bay_m;
    add_sweep(mesh, moved, {0, 0, -bay_m}, true);
  }
  return finished(std::move(mesh), "vault", m.vault);
}

Mesh end_walls(const Materials& m) {
  Mesh mesh;
  add_front(mesh, apse_wall());
  add_front(mesh, entrance_wall());
  add_reveal(mesh, entrance_wall(), 0.5f);
  return finished(std::move(mesh), "end walls", m.stone);
}

Mesh apse(const Materials& m) {
  Mesh mesh;
  add_reveal(mesh, apse_wall(), 2.4f);
  add_back(mesh, apse_wall(), 2.4f);
  return finished(std::move(mesh), "apse", m.mosaic);
}

Mesh backing(const Materials& m, glm::vec3 low, glm::vec3 high) {
  Mesh mesh;
  const glm::vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  add_quad(mesh, low + z, x, -z);
  add_quad(mesh, low + y, x, z);
  add_quad(mesh, low + z, -z, y);
  add_quad(mesh, low + x, z, y);
  add_quad(mesh, low, x, y);
  add_quad(mesh, low + x + z, -x, y);
  return finished(std::move(mesh), "backing", m.stone);
}

Mesh dais(const Materials& m) {
  Mesh mesh;
  for (int step = 0; step < 3; ++step) {
    const float half_width = 2.9f - 0.25f * step, front = -11 - 0.4f * step;
    add_box(mesh, {-half_width, 0.2f * step, -half_length_m}, {half_width, 0.2f * (step + 1), front});
  }
  return finished(std::move(mesh), "dais", m.marble);
}

Mesh rose_window(const Materials& m) {
  constexpr float radius = 1.35f;
  const glm::vec3 center(0, 7.7f, -half_length_m + 0.03f);
  Mesh mesh;
  std::vector<SurfacePoint> points;
  const auto rim =
      arc(glm::vec3(0), {1, 0, 0}, {0, 1, 0}, -glm::half_pi<float>(), 1.5f * glm::pi<float>(), 64);
  for (const float ring : {radius, 0.004f}) {
    for (const glm::vec3& p : rim) {
      const glm::vec3 at = p * ring;
      points.push_back(
          {center + at, {0, 0, 1}, {1, 0, 0}, {0.5f + at.x / radius / 2, 0.5f - at.y / radius / 2}});
    }
  }
  add_grid(mesh, 64, 1, points);
  return finished(std::move(mesh), "rose window", m.rose_window);
}

Mesh door(const Materials& m) {
  Mesh mesh;
  add_back(mesh, entrance_wall(), 0.5f);
  return finished(std::move(mesh), "door", m.wood);
}

Mesh balcony(const Materials& m) {
  Mesh mesh;
  add_box(mesh, {-nave_half_width_m, 4.05f, 12.4f}, {nave_half_width_m, 4.3f, half_length_m});
  add_box(mesh, {-nave_half_width_m, 5.14f, 12.45f}, {nave_half_width_m, 5.26f, 12.75f});
  for (const float x : {-2.6f, -0.9f, 0.9f, 2.6f}) {
    add_box(mesh, {x - 0.1f, 3.6f, 12.6f}, {x + 0.1f, 4.05f, half_length_m});
  }
  return finished(std::move(mesh), "balcony", m.trim);
}

}  // namespace lightgrid::hall
