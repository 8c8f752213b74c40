// The parts of the gallery. Metres, y up; busts look along +z.
#pragma once

#include "scene/scene.h"

namespace lightgrid::gallery {

// A head on shoulders, 0.63 m tall, on y = 0.
Mesh bust(int material);

// A socle for it: turned, 0.12 m tall.
Mesh socle(int material);

// A square column 0.56 m wide at its foot.
Mesh plinth(int material, float height_m);

// Cloth that hangs in the plane z = 0, from x = 0 to `width_m` and from y = `height_m` down to y = 0, in
// folds that grow downward. Its front looks along +z.
Mesh drapery(int material, float width_m, float height_m, float fold_m, double phase);

// A ball for the table of samples, or a lamp.
Mesh ball(int material, float radius_m, int cells_per_edge);

// Box with the given corners.
Mesh box(int material, const char* name, glm::vec3 low, glm::vec3 high);

}  // namespace lightgrid::gallery
