#include "scenes/compose.h"
#include "scenes/patterns.h"
#include "scenes/street_parts.h"

namespace lightgrid::street {
namespace {

// Wet: dark, smooth in the puddles, coarse between them.
SurfaceMaps asphalt() {
  using namespace patterns;
  const int size = 256;
  const Field grain = noise(size, 64, 64, 2, 61), puddles = noise(size, 3, 3, 4, 62);
  Field height(size), roughness(size);
  Bitmap colors = color_bitmap("asphalt", size, [&](int x, int y) {
    const float dry = step_between(0.42f, 0.58f, puddles.at(x, y));
    height.at(x, y) = grain.at(x, y) * (0.15f + 1.4f * dry);
    roughness.at(x, y) = 0.24f + 0.5f * dry;
    return glm::vec4(glm::vec3(0.085f, 0.085f, 0.09f) * (0.5f + 0.4f * dry + 0.5f * grain.at(x, y)), 1);
  });
  return {std::move(colors), normal_bitmap("asphalt normals", height),
          roughness_bitmap("asphalt roughness", roughness)};
}

int add_glowing(Scene& scene, const char* name, glm::vec3 color, float radiance) {
  const int material = add_material(scene, name, color * 0.3f, 0, 0.5f);
  scene.materials[material].emissive = color * radiance;
  return material;
}

}  // namespace

Materials add_materials(Scene& scene) {
  Materials m;
  m.asphalt = add_material(scene, "asphalt", glm::vec3(1), 0, 1);
  use_maps(scene, m.asphalt, asphalt(), 6);
  m.paving = add_material(scene, "paving", glm::vec3(1), 0, 0.6f);
  use_maps(scene, m.paving,
           masonry({"paving", 4, 4, 1.5f, {0.30f, 0.29f, 0.28f}, {0.10f, 0.10f, 0.10f}, 1.5f, 63}), 2.4f);
  m.marking = add_material(scene, "road marking", {0.62f, 0.62f, 0.58f}, 0, 0.6f);
  m.walls[0] = add_material(scene, "red brick", glm::vec3(1), 0, 0.85f);
  use_maps(scene, m.walls[0],
           masonry({"red brick", 4, 8, 2.5f, {0.42f, 0.16f, 0.11f}, {0.32f, 0.30f, 0.28f}, 2, 64}), 1);
  m.walls[1] = add_material(scene, "sandstone", glm::vec3(1), 0, 0.85f);
  use_maps(scene, m.walls[1],
           masonry({"sandstone", 3, 5, 2, {0.58f, 0.48f, 0.34f}, {0.25f, 0.21f, 0.16f}, 2, 65}), 2.5f);
  m.walls[2] = add_material(scene, "yellow brick", glm::vec3(1), 0, 0.85f);
  use_maps(scene, m.walls[2],
           masonry({"yellow brick", 4, 8, 2.5f, {0.52f, 0.42f, 0.24f}, {0.24f, 0.23f, 0.22f}, 2, 66}), 1);
  m.walls[3] = add_material(scene, "blue render", {0.30f, 0.38f, 0.46f}, 0, 0.9f);
  m.trim = add_material(scene, "cast stone", {0.58f, 0.55f, 0.50f}, 0, 0.75f);
  m.iron = add_material(scene, "painted iron", {0.07f, 0.09f, 0.085f}, 0.3f, 0.4f);
  m.tyre = add_material(scene, "tyre", {0.03f, 0.03f, 0.03f}, 0, 0.8f);
  m.car_window = add_material(scene, "car window", {0.03f, 0.035f, 0.04f}, 0, 0.1f);
  m.interior = add_material(scene, "shop inside", {0.62f, 0.54f, 0.44f}, 0, 0.8f);
  m.dark_window = add_material(scene, "dark window", {0.04f, 0.05f, 0.06f}, 0, 0.12f);
  m.lit_window = add_glowing(scene, "lit window", {1, 0.72f, 0.40f}, 0.42f);
  m.warm_lamp = add_glowing(scene, "street lamp", {1, 0.70f, 0.38f}, 1.3f);
  m.head_lamp = add_glowing(scene, "head lamp", {1, 0.95f, 0.85f}, 1.5f);
  m.tail_lamp = add_glowing(scene, "tail lamp", {1, 0.08f, 0.05f}, 0.9f);
  m.glass = add_material(scene, "shop glass", {0.45f, 0.55f, 0.58f}, 0, 0.08f);
  scene.materials[m.glass].base_color.a = 0.18f;
  scene.materials[m.glass].alpha_mode = AlphaMode::blend;
  scene.materials[m.glass].double_sided = true;
  const glm::vec3 paints[] = {
      {0.55f, 0.05f, 0.04f}, {0.08f, 0.22f, 0.50f}, {0.62f, 0.63f, 0.65f}, {0.30f, 0.36f, 0.22f}};
  for (int i = 0; i < 4; ++i) m.paints[i] = add_material(scene, "car paint", paints[i], 0.2f, 0.25f);
  for (size_t i = 0; i < neon.size(); ++i) m.neon[i] = add_glowing(scene, "neon", neon[i], 0.95f);
  return m;
}

}  // namespace lightgrid::street
