// A cell of the light grid as the light tests see it: a screen rectangle between two distances.
#pragma once

#include "shared/view_params.h"
#include "shared/light_grid.h"

// Stands for infinity: its square is finite in float, so no test meets inf - inf or 0 * inf.
#define FAR_AWAY 1e18f

// The convex cell, in view space with D = -z. Perspective: slopes x/D and y/D at its four sides; orthographic: x and
// y there. Its box is the view-space AABB around it. near > far: the cell holds no surface.
typedef struct Cell {
  float x0, x1, y0, y1;          // slopes, or metres where orthographic
  float near, far;               // metres
  float box_x0, box_x1, box_y0, box_y1;  // metres
  float norm_x0, norm_x1, norm_y0, norm_y1;  // length of the side planes' (1, 0, -slope)
  bool orthographic;
} Cell;

static inline Cell make_cell(constant ViewParams* view, uint px0, uint py0, uint px1, uint py1, float2 bounds) {
  Cell c;
  c.near = bounds.x, c.far = bounds.y;
  c.orthographic = view->orthographic != 0;
  c.x0 = (float)px0 * view->slope_x_scale + view->slope_x_offset;
  c.x1 = (float)px1 * view->slope_x_scale + view->slope_x_offset;
  c.y0 = (float)py0 * view->slope_y_scale + view->slope_y_offset;
  c.y1 = (float)py1 * view->slope_y_scale + view->slope_y_offset;
  if (c.orthographic) {
    c.box_x0 = c.x0, c.box_x1 = c.x1, c.box_y0 = c.y0, c.box_y1 = c.y1;
    c.norm_x0 = c.norm_x1 = c.norm_y0 = c.norm_y1 = 1.0f;
  } else {
    c.box_x0 = min(c.x0 * c.near, c.x0 * c.far), c.box_x1 = max(c.x1 * c.near, c.x1 * c.far);
    c.box_y0 = min(c.y0 * c.near, c.y0 * c.far), c.box_y1 = max(c.y1 * c.near, c.y1 * c.far);
    c.norm_x0 = sqrt(1.0f + c.x0 * c.x0), c.norm_x1 = sqrt(1.0f + c.x1 * c.x1);
    c.norm_y0 = sqrt(1.0f + c.y0 * c.y0), c.norm_y1 = sqrt(1.0f + c.y1 * c.y1);
  }
  return c;
}
