// The parts of the street, which runs along -z from z = 0. A house's parts are those of the right side (its
// front at x = front_x_m, facing -x), z relative to its middle; cars face -z.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace lightgrid::street {

inline constexpr float length_m = 360, house_m = 9, front_x_m = 8, kerb_x_m = 5;
inline constexpr int houses_a_side = 40, lamp_posts_a_side = 30, cars = 36;
inline constexpr float lamp_spacing_m = 12;

// The height of a string across the street. across: -1 to 1 from side to side.
inline float garland_height_m(float across) { return 5.5f + 1.5f * across * across; }

inline constexpr std::array<glm::vec3, 7> neon = {
    glm::vec3(1, 0.25f, 0.45f), {0.25f, 0.75f, 1}, {1, 0.75f, 0.30f},    {0.35f, 1, 0.60f},
    {0.70f, 0.40f, 1},          {1, 0.45f, 0.20f}, {0.30f, 0.95f, 0.95f}};

struct Materials {
  int asphalt, paving, marking, iron, glass, warm_lamp, tyre, car_window, head_lamp, tail_lamp, interior,
      dark_window, lit_window;
  std::array<int, 4> walls, paints;
  int trim;
  std::array<int, 7> neon;
};
Materials add_materials(Scene& scene);

Mesh road(const Materials& m);
Mesh pavements(const Materials& m);
Mesh markings(const Materials& m);

// Across a house's front: z from its middle, y from the ground.
struct Rectangle {
  float z0, z1, y0, y1;
};
std::vector<Rectangle> windows(int kind);  // three a floor, from below
float height_m(int kind);                  // height of the facade

// Houses of four kinds; kinds 1 and 3 have one more floor. Windows by kind % 2 and one of two patterns of lit
// and dark: [2 * (kind % 2) + pattern].
std::vector<Mesh> facades(const Materials& m);
std::vector<Mesh> lit_windows(const Materials& m);
std::vector<Mesh> dark_windows(const Materials& m);
std::vector<Mesh> house_trims(const Materials& m);  // [kind % 2]
Mesh shop_inside(const Materials& m);
Mesh shop_window(const Materials& m);
std::vector<Mesh> sign_meshes(const Materials& m);

Mesh lamp_post(const Materials& m);
Mesh lamp_head(const Materials& m);
std::vector<Mesh> bulb_meshes(const Materials& m);
Mesh garland_wire(const Materials& m);  // at z = 0

std::vector<Mesh> car_bodies(const Materials& m);
Mesh car_glass(const Materials& m);
Mesh car_wheels(const Materials& m);
Mesh car_lamps(const Materials& m, bool head);

}  // namespace lightgrid::street
