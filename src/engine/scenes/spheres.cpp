// Floating spheres with nothing behind them: every silhouette is a step in depth, and most of a tile's depth
// range is empty. What depth bounds and cull tests find hardest.
#include <algorithm>
#include <cmath>

#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

constexpr int sphere_count = 600, lights_of_spheres = 1024;
constexpr float nearest_m = 2, farthest_m = 90;
constexpr float slope_y = 0.62f, slope_x = 1.08f;  // slightly more than a field of 60 degrees at 16:9

// Uniform on the screen and in log depth: equally dense near and far.
glm::vec3 in_frustum(Random& random) {
  const float depth =
      float(nearest_m * std::exp2(std::log2(double(farthest_m) / nearest_m) * random.uniform()));
  const float x = random.uniform(-slope_x, slope_x), y = random.uniform(-slope_y, slope_y);
  return {x * depth, y * depth, -depth};
}

glm::vec3 palette(float hue) {
  // Six colours of roughly equal luminance, blended: no primary saturates.
  static constexpr glm::vec3 stops[7] = {{1, 0.52f, 0.25f},    {0.95f, 0.75f, 0.3f}, {0.4f, 0.9f, 0.5f},
                                         {0.25f, 0.8f, 0.95f}, {0.4f, 0.5f, 1},      {0.95f, 0.4f, 0.75f},
                                         {1, 0.52f, 0.25f}};
  const float at = hue * 6;
  const int i = std::min(int(at), 5);
  return glm::mix(stops[i], stops[i + 1], at - i);
}

}  // namespace

Scene make_spheres() {
  Scene scene;
  scene.name = "spheres";
  scene.ambient = glm::vec3(0.05f, 0.055f, 0.07f);
  Random random(7);

  const struct {
    const char* name;
    glm::vec3 color;
    float metallic, roughness;
  } looks[] = {{"chalk", {0.82f, 0.80f, 0.76f}, 0, 0.9f},      {"porcelain", {0.75f, 0.78f, 0.82f}, 0, 0.25f},
               {"terracotta", {0.62f, 0.28f, 0.18f}, 0, 0.7f}, {"jade", {0.18f, 0.48f, 0.34f}, 0, 0.35f},
               {"slate", {0.22f, 0.25f, 0.30f}, 0, 0.5f},      {"brass", {0.91f, 0.72f, 0.40f}, 1, 0.35f},
               {"copper", {0.93f, 0.60f, 0.48f}, 1, 0.5f},     {"steel", {0.65f, 0.66f, 0.68f}, 1, 0.28f}};
  constexpr int look_count = std::size(looks);
  for (const auto& look : looks) {
    const int material = add_material(scene, look.name, look.color, look.metallic, look.roughness);
    for (const int cells : {4, 6}) {
      Mesh mesh;
      shapes::add_sphere(mesh, glm::vec3(0), 1, cells);
      add_mesh(scene, shapes::finished(std::move(mesh), std::string("sphere of ") + look.name, material));
    }
  }

  for (int i = 0; i < sphere_count; ++i) {
    const glm::vec3 center = in_frustum(random);
    // Small compared with their distance, so that none fills the picture.
    const float apparent = random.uniform(0.012f, 0.045f), radius = -center.z * apparent + 0.03f;
    add_instance(scene, "sphere " + std::to_string(i), i % look_count * 2 + (apparent > 0.028f),
                 placed(center, 360.0 * random.uniform(), radius));
  }
  for (int i = 0; i < lights_of_spheres; ++i) {
    const glm::vec3 position = in_frustum(random);
    const float radius = -position.z * random.uniform(0.08f, 0.2f) + 0.4f;
    // At half its radius every light is equally bright, whatever its size.
    add_point(scene, "light " + std::to_string(i), position, palette(random.uniform()),
              0.75f * radius * radius, radius);
  }

  add_camera(scene, "front", {0, 0, 0}, {0, 0, -1}, 60);
  add_camera(scene, "side", {60, 18, -30}, {0, 0, -42}, 60);
  return scene;
}

}  // namespace lightgrid
