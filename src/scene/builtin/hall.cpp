#include "scene/builtin/compose.h"
#include "scene/builtin/scenes.h"
#include "scene/builtin/shapes.h"
#include "scene/random.h"

namespace lightgrid {

Scene make_hall() {
  Scene scene;
  scene.name = "hall";
  const int stone = add_material(scene, "stone", {0.6f, 0.55f, 0.5f}, 0, 0.8f);
  const int glass = add_material(scene, "glass", {0.3f, 0.7f, 0.6f}, 0, 0.1f);
  scene.materials[glass].base_color.a = 0.25f;
  scene.materials[glass].alpha_mode = AlphaMode::blend;
  scene.materials[glass].double_sided = true;
  Mesh room;
  shapes::add_quad(room, {-6, 0, 15}, {12, 0, 0}, {0, 0, -30}, 12, 30);
  shapes::add_quad(room, {-6, 0, 15}, {0, 0, -30}, {0, 10, 0}, 30, 10);
  shapes::add_quad(room, {6, 0, -15}, {0, 0, 30}, {0, 10, 0}, 30, 10);
  shapes::add_quad(room, {-6, 0, -15}, {12, 0, 0}, {0, 10, 0}, 12, 10);
  shapes::add_quad(room, {6, 0, 15}, {-12, 0, 0}, {0, 10, 0}, 12, 10);
  shapes::add_quad(room, {-6, 10, -15}, {12, 0, 0}, {0, 0, 30}, 12, 30);
  add_instance(scene, "room", add_mesh(scene, shapes::finished(std::move(room), "room", stone)));
  Mesh column;
  const glm::vec2 profile[] = {{0.5f, 0}, {0.5f, 0.3f}, {0.5f, 0.3f}, {0.35f, 0.4f}, {0.3f, 4.6f}};
  shapes::add_lathe(column, glm::vec3(0), profile, 24);
  const int column_mesh = add_mesh(scene, shapes::finished(std::move(column), "column", stone));
  Mesh pane;
  shapes::add_quad(pane, {0, 0, 1}, {0, 0, -2}, {0, 2, 0});
  const int pane_mesh = add_mesh(scene, shapes::finished(std::move(pane), "pane", glass));
  Random random(3);
  for (int i = 0; i < 8; ++i) {
    for (const double x : {-3.3, 3.3})
      add_instance(scene, "column", column_mesh, placed({x, 0, -13 + 3.75 * i}));
    if (i % 3 == 0) add_instance(scene, "pane", pane_mesh, placed({2.5, 0.2, -11 + 3.75 * i}));
  }
  for (int i = 0; i < 224; ++i) {
    const glm::vec3 at(random.uniform(-5.5f, 5.5f), random.uniform(0.4f, 5), random.uniform(-14.5f, 14.5f));
    add_point(scene, "lamp", at, glm::vec3(random.uniform(0.3f, 1), 0.6f, random.uniform(0.3f, 1)), 1.2f,
              random.uniform(1.5f, 4));
  }
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 at(i % 2 ? 2.f : -2.f, 8, -14 + 1.85f * i);
    add_spot(scene, "key", at, at * glm::vec3(0.5f, 0, 1), {1, 0.8f, 0.55f}, 60, 12, 15, 30);
  }
  add_camera(scene, "entrance", {-1, 1.8, 13.5}, {0.3, 3, -6}, 60);
  return scene;
}

}  // namespace lightgrid
