#include <algorithm>
#include <cmath>

#include "scenes/compose.h"
#include "scenes/hall_parts.h"
#include "scenes/patterns.h"

namespace lightgrid::hall {
namespace {

using namespace patterns;

// 1 where the noise crosses a half, falling off steeply: veins. A product, since pow differs between
// libraries.
float crest(float noise, int steepness) {
  const float base = 1 - 2 * std::abs(noise - 0.5f);
  float product = 1;
  for (int i = 0; i < steepness; ++i) product *= base;
  return product;
}

// Polished slabs, alternating dark and light, with veins; joints are rough.
SurfaceMaps tiles() {
  const int size = 256;
  const Field grain = noise(size, 4, 4, 5, 11), fine = noise(size, 32, 32, 3, 12);
  Field height(size), roughness(size);
  const auto slab = [](const Cell& cell) { return step_between(0.8f, 3, cell.edge_px); };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Cell cell = cell_at(x, y, size, 2, 2, false);
      height.at(x, y) = slab(cell) * 1.6f + fine.at(x, y) * 0.25f + grain.at(x, y) * 1.5f;
      roughness.at(x, y) = 0.9f - slab(cell) * (0.66f - 0.16f * fine.at(x, y));
    }
  }
  Bitmap colors = color_bitmap("floor tiles", size, [&](int x, int y) {
    const Cell cell = cell_at(x, y, size, 2, 2, false);
    const bool light = ((x * 2 / size) + (y * 2 / size)) % 2;
    const float vein = crest(grain.at(x, y), 12);
    const glm::vec3 base = light ? glm::vec3(0.30f, 0.26f, 0.22f) : glm::vec3(0.045f, 0.05f, 0.06f);
    const glm::vec3 slab_color = base * (0.75f + 0.5f * fine.at(x, y)) + vein * (light ? -0.06f : 0.07f);
    return glm::vec4(glm::mix(glm::vec3(0.03f), slab_color, slab(cell)), 1);
  });
  return {std::move(colors), normal_bitmap("floor tile normals", height),
          roughness_bitmap("floor tile roughness", roughness)};
}

SurfaceMaps planks() {
  const int size = 256;
  const Field grain = noise(size, 64, 4, 3, 21), knots = noise(size, 8, 4, 3, 22);
  Field height(size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Cell cell = cell_at(x, y, size, 5, 1, false);
      height.at(x, y) = step_between(0.5f, 4, cell.edge_px) * 2.5f + grain.at(x, y) * 1.4f;
    }
  }
  Bitmap colors = color_bitmap("wood", size, [&](int x, int y) {
    const Cell cell = cell_at(x, y, size, 5, 1, false);
    const float tone = (0.6f + 0.5f * cell.random) * (0.55f + 0.6f * grain.at(x, y) + 0.3f * knots.at(x, y));
    return glm::vec4(glm::vec3(0.36f, 0.19f, 0.085f) * tone * step_between(-1, 3, cell.edge_px), 1);
  });
  return {std::move(colors), normal_bitmap("wood normals", height), {}};
}

// Tesserae of gold glass, each tilted differently, so that each reflects another light.
SurfaceMaps tesserae() {
  const int size = 256, cells = 32;
  Field height(size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Cell cell = cell_at(x, y, size, cells, cells, true);
      const float tilt_x = cell.random - 0.5f, tilt_y = float(cell.hash & 0xffff) / 65535 - 0.5f;
      height.at(x, y) =
          (cell.x * tilt_x + cell.y * tilt_y) * 1.6f + step_between(0, 1.5f, cell.edge_px) * 0.8f;
    }
  }
  Bitmap colors = color_bitmap("mosaic", size, [&](int x, int y) {
    const Cell cell = cell_at(x, y, size, cells, cells, true);
    const bool blue = (cell.hash >> 20) % 9 == 0;
    const glm::vec3 glass = blue ? glm::vec3(0.16f, 0.3f, 0.62f) : glm::vec3(0.86f, 0.6f, 0.22f);
    return glm::vec4(
        glass * (0.6f + 0.4f * cell.random) * (0.3f + 0.7f * step_between(0, 1.2f, cell.edge_px)), 1);
  });
  return {std::move(colors), normal_bitmap("mosaic normals", height), {}};
}

Bitmap marble_bitmap() {
  const int size = 256;
  const Field cloud = noise(size, 3, 3, 5, 31), vein = noise(size, 2, 4, 6, 32);
  return color_bitmap("marble", size, [=](int x, int y) {
    const float line = crest(vein.at(x, y), 24);
    const glm::vec3 body =
        glm::mix(glm::vec3(0.80f, 0.76f, 0.69f), glm::vec3(0.62f, 0.55f, 0.48f), cloud.at(x, y));
    return glm::vec4(glm::mix(body, glm::vec3(0.30f, 0.24f, 0.22f), 0.55f * line), 1);
  });
}

// A night sky: one eight-pointed gold star and four small ones on lapis blue.
Bitmap stars_bitmap() {
  const int size = 128;
  const Field cloud = noise(size, 4, 4, 4, 41);
  const auto star = [](float x, float y, float radius) {
    const float ax = std::abs(x), ay = std::abs(y);
    const float cross = std::min(ax + 4 * ay, ay + 4 * ax), diagonal = 0.72f * std::max(ax, ay) * 2.2f;
    return 1 - step_between(0.8f, 1.2f, std::min(cross, std::max(diagonal, (ax + ay) * 1.4f)) / radius);
  };
  return color_bitmap("stars", size, [=](int x, int y) {
    const float u = (x + 0.5f) / size * 2 - 1, v = (y + 0.5f) / size * 2 - 1;
    const float gold = std::max(star(u, v, 0.42f), star(1 - std::abs(u), 1 - std::abs(v), 0.2f));
    const glm::vec3 sky = glm::vec3(0.05f, 0.10f, 0.32f) * (0.6f + 0.8f * cloud.at(x, y));
    return glm::vec4(glm::mix(sky, glm::vec3(0.95f, 0.68f, 0.22f), gold), 1);
  });
}

// Diamonds in a border, across 2 m of carpet (u) and 1 m along (v).
Bitmap carpet_bitmap() {
  const int size = 256;
  const Field weave = noise(size, 128, 128, 1, 51);
  return color_bitmap("carpet", size, [=](int x, int y) {
    const float u = std::abs((x + 0.5f) / size * 2 - 1), v = std::abs((y + 0.5f) / size * 2 - 1);
    const float diamond = u * 1.6f + v;
    const glm::vec3 red(0.36f, 0.035f, 0.04f), dark(0.12f, 0.02f, 0.05f), gold(0.62f, 0.40f, 0.12f),
        blue(0.04f, 0.07f, 0.2f);
    glm::vec3 color = red;
    if (diamond < 1) color = dark;
    if (diamond > 0.86f && diamond < 1) color = gold;
    if (diamond < 0.45f) color = red;
    if (diamond < 0.2f) color = gold;
    if (u > 0.8f) color = blue;
    if ((u > 0.78f && u < 0.83f) || u > 0.96f) color = gold;
    return glm::vec4(color * (0.7f + 0.6f * weave.at(x, y)), 1);
  });
}

// Crossed bars that leave seven tenths open; coverage falls off over two texels, so that mip levels keep the
// edges.
Bitmap lattice_bitmap() {
  const int size = 64;
  return color_bitmap("lattice", size, [=](int x, int y) {
    const float u = std::abs((x + 0.5f) / size * 2 - 1), v = std::abs((y + 0.5f) / size * 2 - 1);
    const float bar = std::min({u, v, std::abs(u + v - 1) * 0.7f + 0.08f});
    return glm::vec4(1, 1, 1, 1 - step_between(0.06f, 0.20f, bar));
  });
}

// Coloured quarries between dark cames; the glass transmits four fifths.
Bitmap stained_glass_bitmap() {
  const int size = 128;
  return color_bitmap("stained glass", size, [=](int x, int y) {
    // Rotated by 45 degrees: lozenges.
    const int a = (x + y) & (size - 1), b = (x - y + size) & (size - 1);
    const Cell cell = cell_at(a, b, size, 4, 4, false);
    static constexpr glm::vec3 glass[] = {{0.85f, 0.16f, 0.10f}, {0.95f, 0.62f, 0.12f},
                                          {0.10f, 0.28f, 0.85f}, {0.08f, 0.55f, 0.40f},
                                          {0.50f, 0.15f, 0.65f}, {0.85f, 0.78f, 0.60f}};
    const float open = step_between(1, 2.5f, cell.edge_px);
    return glm::mix(glm::vec4(0.02f, 0.02f, 0.025f, 1), glm::vec4(glass[cell.hash % 6], 0.45f), open);
  });
}

// Twelve petals about a centre, over the square -1..1.
Bitmap rose_bitmap() {
  const int size = 256;
  return color_bitmap("rose window", size, [=](int x, int y) {
    const float u = (x + 0.5f) / size * 2 - 1, v = (y + 0.5f) / size * 2 - 1;
    const float radius = std::sqrt(u * u + v * v);
    const float turn = float(std::atan2(double(v), double(u)) / 6.283185307179586 + 1);
    const int ring = radius < 0.22f ? 0 : radius < 0.62f ? 1 : 2;
    const int petals = ring == 0 ? 6 : ring == 1 ? 12 : 24;
    const float across = std::abs(turn * petals - std::floor(turn * petals) - 0.5f) * 2;
    const float width_m = radius * 6.28f / petals / 2;
    const float came = std::min(
        {(1 - across) * width_m, std::abs(radius - 0.22f), std::abs(radius - 0.62f), 0.97f - radius});
    static constexpr glm::vec3 glass[] = {
        {1, 0.75f, 0.3f}, {0.15f, 0.3f, 1}, {0.9f, 0.15f, 0.2f}, {0.55f, 0.2f, 0.85f}, {0.1f, 0.7f, 0.65f}};
    const int petal = int(turn * petals) % petals;
    const glm::vec3 color = ring == 0   ? glass[0]
                            : ring == 1 ? glass[1 + petal % 2]
                                        : glass[(petal % 3) + (petal % 2 ? 1 : 2)];
    return glm::vec4(color * step_between(0.012f, 0.03f, came) * (1.15f - 0.5f * radius), 1);
  });
}

int add_lamp(Scene& scene, const char* name, glm::vec3 color) {
  const int material = add_material(scene, name, color * 0.3f, 0, 0.5f);
  scene.materials[material].emissive = color * 1.05f;
  return material;
}

}  // namespace

Materials add_materials(Scene& scene) {
  Materials m;
  m.stone = add_material(scene, "stone blocks", glm::vec3(1), 0, 0.85f);
  use_maps(scene, m.stone, masonry({"stone", 2, 4, 2, {0.56f, 0.48f, 0.39f}, {0.22f, 0.19f, 0.16f}, 2.2f, 1}),
           2);
  m.brick = add_material(scene, "brick", glm::vec3(1), 0, 0.8f);
  use_maps(scene, m.brick,
           masonry({"brick", 4, 8, 2.5f, {0.46f, 0.17f, 0.10f}, {0.34f, 0.31f, 0.28f}, 2.5f, 2}), 1);
  m.floor = add_material(scene, "floor tiles", glm::vec3(1), 0, 1);
  use_maps(scene, m.floor, tiles(), 1.5f);
  m.wood = add_material(scene, "wood", glm::vec3(1), 0, 0.6f);
  use_maps(scene, m.wood, planks(), 1);
  m.mosaic = add_material(scene, "gold mosaic", glm::vec3(1), 0.85f, 0.38f);
  use_maps(scene, m.mosaic, tesserae(), 1);
  m.trim = add_material(scene, "pale stone", {0.62f, 0.57f, 0.50f}, 0, 0.7f);
  m.marble = add_material(scene, "marble", glm::vec3(1), 0, 0.28f);
  use_color(scene, m.marble, marble_bitmap(), 1.8f);
  m.vault = add_material(scene, "painted plaster", glm::vec3(1), 0, 0.9f);
  use_color(scene, m.vault, stars_bitmap(), 0.9f);
  m.carpet = add_material(scene, "carpet", glm::vec3(1), 0, 0.95f);
  use_color(scene, m.carpet, carpet_bitmap(), 2);
  m.bronze = add_material(scene, "bronze", {0.55f, 0.36f, 0.20f}, 1, 0.42f);
  m.gold = add_material(scene, "gold", {1.0f, 0.76f, 0.34f}, 1, 0.3f);
  m.iron = add_material(scene, "iron", {0.16f, 0.16f, 0.17f}, 0.6f, 0.5f);
  m.porcelain = add_material(scene, "porcelain", {0.78f, 0.80f, 0.84f}, 0, 0.22f);
  m.jade = add_material(scene, "jade", {0.16f, 0.44f, 0.30f}, 0, 0.3f);
  m.lattice = add_material(scene, "iron lattice", {0.20f, 0.19f, 0.18f}, 0.5f, 0.5f);
  use_color(scene, m.lattice, lattice_bitmap(), 0.35f);
  scene.materials[m.lattice].alpha_mode = AlphaMode::mask;
  scene.materials[m.lattice].double_sided = true;

  m.clear_glass = add_material(scene, "clear glass", {0.55f, 0.72f, 0.70f}, 0, 0.08f);
  scene.materials[m.clear_glass].base_color.a = 0.16f;
  m.stained_glass = add_material(scene, "stained glass", glm::vec3(1), 0, 0.15f);
  use_color(scene, m.stained_glass, stained_glass_bitmap(), 0.8f);
  for (const int glass : {m.clear_glass, m.stained_glass}) {
    scene.materials[glass].alpha_mode = AlphaMode::blend;
    scene.materials[glass].double_sided = true;
  }
  m.rose_window = add_material(scene, "rose window", glm::vec3(0.2f), 0, 0.4f);
  scene.materials[m.rose_window].emissive = glm::vec3(1.1f);
  const int rose = add_texture(scene, rose_bitmap(), true);
  scene.materials[m.rose_window].base_color_map.texture = rose;
  scene.materials[m.rose_window].emissive_map.texture = rose;

  m.lamp_warm = add_lamp(scene, "warm lamp", {1, 0.62f, 0.28f});
  m.lamp_rose = add_lamp(scene, "rose lamp", {1, 0.36f, 0.40f});
  m.lamp_violet = add_lamp(scene, "violet lamp", {0.62f, 0.38f, 1});
  m.lamp_blue = add_lamp(scene, "blue lamp", {0.30f, 0.55f, 1});
  m.lamp_teal = add_lamp(scene, "teal lamp", {0.22f, 0.85f, 0.72f});
  return m;
}

}  // namespace lightgrid::hall
