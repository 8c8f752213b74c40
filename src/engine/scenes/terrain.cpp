// Hills under 255 small lights, seen from above: the kind of scene in which Light Indexed Deferred Rendering
// was presented (Trebilco, Light Indexed Deferred Lighting, 2007), whose 8-bit indices allow 255 lights.
#include <algorithm>
#include <cmath>

#include "scene/random.h"
#include "scenes/builtin.h"
#include "scenes/compose.h"
#include "scenes/patterns.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

constexpr int cells = 142;  // 2 * 142^2 = 40,328 triangles
constexpr float side_m = 120, height_m = 17;
constexpr int lights_of_terrain = 255;

class Hills {
 public:
  Hills() : broad_(patterns::noise(512, 5, 5, 4, 101)), rough_(patterns::noise(512, 28, 28, 4, 202)) {}

  // x and z in -side/2 .. side/2. A bowl: low in the middle, rising towards the rim.
  float height(float x, float z) const {
    const float u = x / side_m + 0.5f, v = z / side_m + 0.5f;
    const float from_middle = std::min(1.f, std::sqrt(x * x + z * z) / (0.5f * side_m));
    const float broad = sample(broad_, u, v);
    return height_m * (1.6f * broad * broad + 0.55f * from_middle * from_middle) +
           1.3f * sample(rough_, u, v);
  }

  glm::vec3 normal(float x, float z) const {
    constexpr float step = side_m / cells / 2;
    return glm::normalize(glm::vec3(height(x - step, z) - height(x + step, z), 2 * step,
                                    height(x, z - step) - height(x, z + step)));
  }

 private:
  static float sample(const patterns::Field& field, float u, float v) {
    // Only the inside of the square, because opposite edges repeat.
    const float x = (0.02f + 0.96f * u) * field.size(), y = (0.02f + 0.96f * v) * field.size();
    const int column = int(std::floor(x)), row = int(std::floor(y));
    const float tx = x - column, ty = y - row;
    const float a = glm::mix(field.at(column, row), field.at(column + 1, row), tx);
    const float b = glm::mix(field.at(column, row + 1), field.at(column + 1, row + 1), tx);
    return glm::mix(a, b, ty);
  }

  patterns::Field broad_, rough_;
};

Mesh ground(const Hills& hills, int material) {
  std::vector<shapes::SurfacePoint> points;
  points.reserve((cells + 1) * (cells + 1));
  Mesh mesh;
  for (int row = 0; row <= cells; ++row) {
    for (int column = 0; column <= cells; ++column) {
      const float x = side_m * (float(column) / cells - 0.5f), z = side_m * (0.5f - float(row) / cells);
      const glm::vec3 normal = hills.normal(x, z);
      points.push_back({{x, hills.height(x, z), z}, normal, {1, 0, 0}, {x, z}});
      // Grass where it is flat and low, rock where it is steep, pale on the heights.
      const float steep = patterns::step_between(0.12f, 0.35f, 1 - normal.y);
      const float high = patterns::step_between(10, 20, hills.height(x, z));
      const glm::vec3 grass(0.30f, 0.40f, 0.19f), rock(0.42f, 0.36f, 0.31f), pale(0.72f, 0.70f, 0.68f);
      mesh.colors.emplace_back(glm::mix(glm::mix(grass, pale, high), rock, steep), 1.f);
    }
  }
  shapes::add_grid(mesh, cells, cells, points);
  return shapes::finished(std::move(mesh), "ground", material);
}

Bitmap soil_normals() {
  patterns::Field height = patterns::noise(256, 16, 16, 4, 303);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) height.at(x, y) *= 5;
  }
  return patterns::normal_bitmap("soil normals", height);
}

}  // namespace

Scene make_terrain() {
  Scene scene;
  scene.name = "terrain";
  scene.ambient = glm::vec3(0.022f, 0.027f, 0.042f);
  scene.background = glm::vec3(0.008f, 0.012f, 0.026f);
  const int material = add_material(scene, "ground", glm::vec3(1), 0, 0.75f);
  scene.materials[material].normal_map = repeat_every(add_texture(scene, soil_normals(), false), 4);
  const Hills hills;
  add_instance(scene, "ground", add_mesh(scene, ground(hills, material)));

  static constexpr glm::vec3 colors[] = {{1, 0.30f, 0.22f},     {1, 0.62f, 0.20f},     {0.95f, 0.90f, 0.35f},
                                         {0.35f, 0.95f, 0.40f}, {0.25f, 0.80f, 0.95f}, {0.35f, 0.45f, 1},
                                         {0.80f, 0.40f, 1},     {1, 0.40f, 0.70f}};
  // A visible lamp under each light.
  std::vector<int> lamps;
  for (const glm::vec3& color : colors) {
    const int lamp = add_material(scene, "lamp", color * 0.3f, 0, 0.5f);
    scene.materials[lamp].emissive = color;
    Mesh mesh;
    shapes::add_sphere(mesh, glm::vec3(0), 0.16f, 2);
    lamps.push_back(add_mesh(scene, shapes::finished(std::move(mesh), "lamp", lamp)));
  }
  Random random(5);
  for (int i = 0; i < lights_of_terrain; ++i) {
    // One at a random position in each cell of a 16 by 16 grid: no clumps, no rows.
    const float x = side_m * ((i % 16 + random.uniform(0.1f, 0.9f)) / 16 - 0.5f) * 0.97f;
    const float z = side_m * ((i / 16 + random.uniform(0.1f, 0.9f)) / 16 - 0.5f) * 0.97f;
    const float radius = random.uniform(6, 11), above = random.uniform(0.9f, 1.8f);
    const glm::vec3 at(x, hills.height(x, z) + above, z);
    const int color = int(random.next() >> 61);
    add_lamp(scene, "lamp", lamps[color], placed(at));
    add_point(scene, "light " + std::to_string(i), at, colors[color], 4.0f * above * above, radius);
  }
  Light& moon = scene.lights.emplace_back();
  moon.name = "moon";
  moon.type = LightType::directional;
  moon.direction = glm::normalize(glm::vec3(-0.5f, -0.6f, 0.35f));
  moon.color = {0.55f, 0.68f, 1};
  moon.intensity = 0.22f;

  add_camera(scene, "ridge", {-6, 33, 66}, {2, 3, -4}, 55);
  add_camera(scene, "valley", {3, hills.height(3, 30) + 4.0, 30}, {-2, hills.height(-2, -20) + 2.0, -20}, 60);
  return scene;
}

}  // namespace lightgrid
