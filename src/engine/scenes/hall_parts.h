// The hall's materials and meshes; hall.cpp places them.
//
// The hall is 30 m along z and 12 m along x: a nave 6 m wide under a barrel vault, an aisle on each side,
// eight bays of 3.75 m. Parts of a bay are those of the right side (x > 0), with z relative to the middle of
// the bay; the left side is the same, turned by 180 degrees.
#pragma once

#include "scene/scene.h"

namespace lightgrid::hall {

inline constexpr float half_length_m = 15, half_width_m = 6, bay_m = 3.75f, nave_half_width_m = 3,
                       wall_m = 0.6f;
inline constexpr int bays = 8;
inline constexpr float springing_m = 4.8f, vault_springing_m = 6.8f, aisle_height_m = 6.6f;
inline constexpr float column_x_m = nave_half_width_m + wall_m / 2;

struct Materials {
  int stone, brick, trim, marble, floor, wood, vault, carpet, mosaic;
  int bronze, gold, iron, lattice, porcelain, jade;
  int clear_glass, stained_glass, rose_window;
  int lamp_warm, lamp_rose, lamp_violet, lamp_blue, lamp_teal;
};
Materials add_materials(Scene& scene);

// Parts of a bay, right side.
Mesh bay_stone(const Materials& m);     // arcade wall on both faces, outer wall
Mesh bay_brick(const Materials& m);     // niche
Mesh bay_trim(const Materials& m);      // arch, its moulding, cornice, plinth of the urn
Mesh bay_wood(const Materials& m);      // aisle ceiling
Mesh bay_tympanum(const Materials& m);  // stained glass in the arch
Mesh bay_lattice(const Materials& m);   // iron gate between the columns
Mesh bay_lattice_frame(const Materials& m);
Mesh bay_vitrine(const Materials& m);  // a pane in front of the niche

// A standing screen across x, seen from both sides.
Mesh screen_glass(const Materials& m);
Mesh screen_frame(const Materials& m);

// Rotationally symmetric about the y axis, standing on y = 0; the rib lies about z = 0.
Mesh column_shaft(const Materials& m);
Mesh column_stone(const Materials& m);
Mesh column_rings(const Materials& m);
Mesh rib(const Materials& m);
Mesh urn(int material);
Mesh chandelier(const Materials& m);
Mesh candle_stand(const Materials& m);
Mesh sconce(const Materials& m);
Mesh lantern(const Materials& m);
Mesh lamp_globe(int material, float radius_m);
Mesh baluster(const Materials& m);
Mesh armillary(const Materials& m);
Mesh pedestal(const Materials& m);

// At their final positions.
Mesh floor_slab(const Materials& m);
Mesh carpet(const Materials& m);
Mesh vault(const Materials& m);
Mesh end_walls(const Materials& m);
Mesh apse(const Materials& m);
// A box around the hall, seen from inside: the edges that instances share round differently, and single
// pixels between them would otherwise show the background.
Mesh backing(const Materials& m, glm::vec3 low, glm::vec3 high);
Mesh dais(const Materials& m);
Mesh rose_window(const Materials& m);
Mesh door(const Materials& m);
Mesh balcony(const Materials& m);

}  // namespace lightgrid::hall
