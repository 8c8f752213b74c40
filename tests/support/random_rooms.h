// Scenes of flat and solid pieces, some of them touching, with lights of which the plan leaves many out
// (plan/light_shadows.h).
#pragma once

#include "scene/camera.h"
#include "scene/random.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {

struct RandomRoom {
  Scene scene;
  View view;
};

// Every light casts. `far_m`: how far from the world's origin.
inline RandomRoom random_room(Random& random, int width, int height, double far_m = 0) {
  RandomRoom room;
  Scene& scene = room.scene;
  add_material(scene, "plaster", {0.7f, 0.6f, 0.5f}, 0, 0.8f);
  const int glass = add_material(scene, "glass", {0.5f, 0.8f, 0.9f}, 0, 0.1f);
  scene.materials[size_t(glass)].base_color.a = 0.4f;
  scene.materials[size_t(glass)].alpha_mode = AlphaMode::blend;
  scene.materials[0].double_sided = scene.materials[1].double_sided = true;
  const auto mesh = [&](const char* name, int material, auto&& add) {
    Mesh made;
    add(made);
    return add_mesh(scene, shapes::finished(std::move(made), name, material));
  };
  const int quad = mesh("quad", 0, [](Mesh& m) {
    shapes::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 3, 2);
  });
  const int wall = mesh("wall", 0, [](Mesh& m) {
    shapes::add_quad(m, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 2, 2);
  });
  const int pane = mesh("pane", glass, [](Mesh& m) {
    shapes::add_quad(m, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  });
  const int box = mesh("box", 0, [](Mesh& m) { shapes::add_box(m, {-0.4f, 0, -0.4f}, {0.4f, 0.8f, 0.4f}); });
  const int ball = mesh("ball", 0, [](Mesh& m) { shapes::add_sphere(m, {0, 0, 0}, 0.5f, 3); });
  const glm::dvec3 origin(far_m, 0.5 * far_m, -far_m);
  // Half-metres, so that pieces touch and share planes.
  const auto somewhere = [&] {
    return glm::dvec3(std::round(random.uniform(-8, 8)), std::round(random.uniform(-3, 3)),
                      std::round(random.uniform(-8, 8))) *
           0.5;
  };
  const int meshes[] = {quad, quad, quad, wall, wall, pane, box, ball};
  const int pieces = 2 + int(random.next() % 7);
  for (int i = 0; i < pieces; ++i) {
    const int chosen = meshes[random.next() % std::size(meshes)];
    const double degrees = random.next() % 4 == 0 ? random.uniform(0, 360) : 90 * double(random.next() % 4);
    add_instance(scene, scene.meshes[size_t(chosen)].name, chosen, placed(origin + somewhere(), degrees));
    scene.instances.back().casts_shadow = random.next() % 8 != 0;
  }
  for (int i = 0; i < 24; ++i) {
    Light light;
    light.name = "lamp";
    light.position = origin + somewhere() + 0.3 * any_direction(random);
    light.radius_m = random.uniform(0.2f, 3);
    light.casts_shadow = true;
    if (random.next() % 3 == 0) {
      light.type = LightType::spot;
      light.direction = glm::vec3(any_direction(random));
      light.inner_cone_rad = 0.1f;
      light.outer_cone_rad = random.uniform(0.2f, 1.5f);
    }
    scene.lights.push_back(light);
  }
  const glm::dvec3 eye = origin + 3.0 * any_direction(random);
  room.view = make_view(look_at(eye, origin + 0.5 * somewhere()), width, height);
  return room;
}

}  // namespace lightgrid
