// The parts of the square besides those of the street (street_parts.h), each around its own origin, y up from
// the ground. Parts of a house are in its frame: front at x = street::front_x_m, facing -x.
#pragma once

#include <array>
#include <span>

#include "scenes/street_parts.h"

namespace lightgrid::square {

struct Materials {
  int setts, kerb, bark, leaves, hedge, hedge_core, ivy, slate, rattan, zinc, china, water, bulb;
  std::array<int, 3> canvas;
};
Materials add_materials(Scene& scene);

// A tube around a polyline, open at its ends.
void add_tube(Mesh& mesh, std::span<const glm::vec3> line, float radius_m, int sides);

// Ground. A patch of rounded setts, patch_m long and wide from its corner; and a flat one with their image.
inline constexpr float patch_m = 2.4f;
Mesh setts(const Materials& m);
Mesh flat_setts(const Materials& m, int patches_x, int patches_z);
Mesh kerb(const Materials& m);  // 1.2 m along z

// Foliage: cards cut out by a mask, in clumps. `cards` fewer and `card_m` larger for plants far away.
Mesh crown(const Materials& m, int cards, float card_m, uint64_t seed);
Mesh trunk(const Materials& m);
inline constexpr float hedge_m = 1.6f;  // along z
Mesh hedge(const Materials& m, int cards, float card_m, uint64_t seed);
Mesh hedge_core(const Materials& m);
Mesh hedge_box(const Materials& m);
Mesh ivy(const Materials& m, uint64_t seed);      // on a house's front, by its corner
Mesh flowers(const Materials& m, uint64_t seed);  // on a window sill of 1.2 m along z

// Furniture. A coarse one has the same outline in fewer triangles.
Mesh table(const Materials& m, bool fine);
Mesh crockery(const Materials& m);  // on a table
Mesh chair(const Materials& m, bool fine);
Mesh parasol_canopy(const Materials& m, int canvas);
Mesh parasol_pole(const street::Materials& m);
Mesh lantern_post(const street::Materials& m, bool fine);
Mesh lantern(const street::Materials& m);  // the light is at lantern_height_m
inline constexpr float table_m = 0.74f, parasol_lamp_m = 2.25f, lantern_height_m = 4.35f;
Mesh bollard(const street::Materials& m);
Mesh bench(const Materials& m);
Mesh fountain(const street::Materials& m);
Mesh fountain_water(const Materials& m);

// Houses.
Mesh body(const street::Materials& m, int kind);  // walls behind the facade
Mesh roof(const Materials& m, int kind);
Mesh chimneys(const street::Materials& m, int kind);
Mesh railing(const street::Materials& m, bool fine);  // before a window of 1.2 m, its sill at y = 0

// Wires: a line that sags, from one place to another.
std::vector<glm::vec3> sagging(glm::vec3 from, glm::vec3 to, float sag_m, int segments);

}  // namespace lightgrid::square
