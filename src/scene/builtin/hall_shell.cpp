// Floor, vault and end walls: the parts that exist once.
#include "scene/builtin/hall_parts.h"
#include "scene/builtin/shapes.h"

namespace lightgrid::hall {
namespace {

using namespace shapes;

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
