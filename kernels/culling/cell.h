// A cell of the light grid as the light tests see it: a screen rectangle between two distances.
#pragma once

#include "kernels/culling/project.h"
#include "shared/light_grid.h"

// Slopes x/d and y/d at a tile's four sides; orthographic: x and y there, metres.
typedef struct TileSides {
  real x0, x1, y0, y1;
} TileSides;

// tx, ty: whole numbers. The last tile of a row or column ends at the view's edge.
static inline TileSides tile_sides(real tx, real ty, constant CullParams* p) {
  const float size = (float)p->tile_size, inset = p->inset;
  TileSides s;
  s.x0 = (tx * size + inset) * p->slope_x_scale + p->slope_x_offset;
  s.y0 = (ty * size + inset) * p->slope_y_scale + p->slope_y_offset;
  s.x1 = (lane_min(tx * size + size, (real)((float)p->width)) - inset) * p->slope_x_scale + p->slope_x_offset;
  s.y1 =
      (lane_min(ty * size + size, (real)((float)p->height)) - inset) * p->slope_y_scale + p->slope_y_offset;
  return s;
}

// The view-space box around the tile's sides between two distances, near <= far.
typedef struct Box {
  real x0, x1, y0, y1;
} Box;

static inline Box box_between(TileSides s, real near, real far, constant CullParams* p) {
  Box b = {s.x0, s.x1, s.y0, s.y1};
  if (!p->orthographic) {
    b.x0 = lane_min(s.x0 * near, s.x0 * far);
    b.x1 = lane_max(s.x1 * near, s.x1 * far);
    b.y0 = lane_min(s.y0 * near, s.y0 * far);
    b.y1 = lane_max(s.y1 * near, s.y1 * far);
  }
  return b;
}

// A cell as the tests read it. near > far: it holds no surface.
typedef struct Cell {
  float near, far;                       // metres
  float box_x0, box_x1, box_y0, box_y1;  // metres
#if CULL_TEST == CULL_EXACT
  float x0, x1, y0, y1;  // as TileSides
#endif
} Cell;
