#include <algorithm>
#include <cmath>

#include "scene/random.h"
#include "scenes/compose.h"
#include "scenes/patterns.h"
#include "scenes/square_parts.h"

namespace lightgrid::square {
namespace {

struct Leaf {
  glm::vec2 center, along;  // half the leaf's length, in texels
  float half_width_px, shade;
};

// A sprig: leaves that point away from the middle, whose shape is the image's coverage.
Bitmap sprig(const char* name, int count, float half_length, float slimness, glm::vec3 color, uint64_t seed) {
  const int size = 64;
  Random random(seed);
  std::vector<Leaf> leaves;
  for (int i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * (i + 0.7 * random.uniform()) / count;
    const glm::vec2 direction(float(std::cos(angle)), float(std::sin(angle)));
    const float half = size * half_length * random.uniform(0.8f, 1.1f);
    const float out = i == 0 ? 0 : size * 0.5f * 0.94f - half;
    leaves.push_back({glm::vec2(size / 2.f) + direction * out, direction * half, half * slimness,
                      random.uniform(0.6f, 1.3f)});
  }
  return patterns::color_bitmap(name, size, [&](int x, int y) {
    glm::vec4 texel(color * 0.8f, 0);
    for (const Leaf& leaf : leaves) {
      const glm::vec2 p = glm::vec2(x + 0.5f, y + 0.5f) - leaf.center;
      const float half = glm::length(leaf.along), along = glm::dot(p, leaf.along) / (half * half);
      const float across = std::abs(p.x * leaf.along.y - p.y * leaf.along.x) / half;
      const float inside = leaf.half_width_px * (1 - along * along) - across;
      if (inside < -0.7f) continue;
      const float vein = across < 0.9f ? 1.35f : 1;
      texel = glm::vec4(color * leaf.shade * vein * (0.85f + 0.25f * along),
                        std::max(texel.a, glm::clamp(0.5f + inside / 1.4f, 0.f, 1.f)));
    }
    return texel;
  });
}

int add_leaves(Scene& scene, const char* name, Bitmap image, float roughness) {
  const int material = add_material(scene, name, glm::vec3(1), 0, roughness);
  use_color(scene, material, std::move(image), 1);
  scene.materials[material].alpha_mode = AlphaMode::mask;
  scene.materials[material].alpha_cutoff = 0.4f;
  scene.materials[material].double_sided = true;
  return material;
}

// Granite setts of 0.2 m, wet here and there.
SurfaceMaps wet_setts() {
  using namespace patterns;
  SurfaceMaps maps = masonry({"setts", 8, 8, 3, {0.25f, 0.24f, 0.235f}, {0.05f, 0.048f, 0.045f}, 9, 81});
  const int size = maps.color.width;
  const Field puddles = noise(size, 2, 2, 4, 82);
  Field roughness(size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x)
      roughness.at(x, y) = 0.3f + 0.42f * step_between(0.4f, 0.6f, puddles.at(x, y));
  }
  maps.roughness = roughness_bitmap("setts roughness", roughness);
  return maps;
}

Bitmap stripes(const char* name, glm::vec3 color) {
  return patterns::color_bitmap(name, 64, [&](int x, int y) {
    const float weave = 0.93f + 0.07f * ((x + y) % 2);
    return glm::vec4((x < 32 ? color : glm::vec3(0.72f, 0.68f, 0.58f)) * weave, 1);
  });
}

Bitmap woven(const char* name) {
  return patterns::color_bitmap(name, 64, [](int x, int y) {
    const bool over = (x / 8 + y / 8) % 2;
    const int edge = over ? y % 8 : x % 8;
    const float shade = edge == 0 || edge == 7 ? 0.4f : 1;
    return glm::vec4((over ? glm::vec3(0.50f, 0.30f, 0.13f) : glm::vec3(0.62f, 0.50f, 0.30f)) * shade, 1);
  });
}

}  // namespace

Materials add_materials(Scene& scene) {
  Materials m;
  m.setts = add_material(scene, "setts", glm::vec3(1), 0, 1);
  use_maps(scene, m.setts, wet_setts(), 1.6f);
  m.kerb = add_material(scene, "granite kerb", {0.33f, 0.32f, 0.31f}, 0, 0.6f);
  m.bark = add_material(scene, "bark", glm::vec3(1), 0, 0.9f);
  use_maps(scene, m.bark, masonry({"bark", 6, 3, 6, {0.24f, 0.19f, 0.13f}, {0.10f, 0.075f, 0.05f}, 4, 83}),
           0.7f);
  m.leaves = add_leaves(scene, "leaves", sprig("leaves", 9, 0.2f, 0.55f, {0.13f, 0.27f, 0.06f}, 84), 0.55f);
  m.hedge = add_leaves(scene, "hedge", sprig("hedge", 12, 0.15f, 0.5f, {0.09f, 0.22f, 0.07f}, 85), 0.5f);
  m.ivy = add_leaves(scene, "ivy", sprig("ivy", 6, 0.23f, 0.75f, {0.10f, 0.20f, 0.07f}, 86), 0.45f);
  m.hedge_core = add_material(scene, "hedge core", {0.025f, 0.045f, 0.02f}, 0, 1);
  m.slate = add_material(scene, "slate", glm::vec3(1), 0, 0.5f);
  use_maps(scene, m.slate,
           masonry({"slate", 6, 10, 1.2f, {0.11f, 0.125f, 0.15f}, {0.03f, 0.03f, 0.035f}, 2, 87}), 2);
  m.rattan = add_material(scene, "rattan", glm::vec3(1), 0, 0.6f);
  use_color(scene, m.rattan, woven("rattan"), 0.12f);
  m.zinc = add_material(scene, "zinc", {0.55f, 0.56f, 0.58f}, 0.8f, 0.35f);
  m.china = add_material(scene, "china", {0.75f, 0.74f, 0.70f}, 0, 0.2f);
  m.water = add_material(scene, "water", {0.02f, 0.05f, 0.06f}, 0, 0.07f);
  m.bulb = add_material(scene, "small bulb", {0.3f, 0.24f, 0.15f}, 0, 0.5f);
  scene.materials[m.bulb].emissive = {1.5f, 1.0f, 0.5f};
  const glm::vec3 dyes[] = {{0.50f, 0.05f, 0.04f}, {0.05f, 0.22f, 0.12f}, {0.10f, 0.13f, 0.36f}};
  for (int i = 0; i < 3; ++i) {
    m.canvas[i] = add_material(scene, "canvas", glm::vec3(1), 0, 0.9f);
    use_color(scene, m.canvas[i], stripes("canvas", dyes[i]), 0.785398f);
    scene.materials[m.canvas[i]].double_sided = true;
  }
  return m;
}

}  // namespace lightgrid::square
