// The convex part of view space within a tile and a range of depths, and its exact distance to a point.
#pragma once

#include "scene/camera.h"

namespace lightgrid {

// A truncated pyramid with its apex at the eye; a box if the view is orthographic. Closed: its faces belong
// to it.
struct Cell {
  double x0 = 0, x1 = 0, y0 = 0,
         y1 = 0;             // x / -z and y / -z; plain x and y (metres) where orthographic; x0 <= x1
  double near = 0, far = 0;  // along -z, metres; near <= far, far may be infinite; near >= 0 if perspective
  bool orthographic = false;

  // The cross-section's scale at a distance along -z.
  double scale_at(double depth_view) const { return orthographic ? 1 : depth_view; }
};

// The cell of pixels [px0, px1) x [py0, py1), row 0 at the bottom; handles off-centre projections.
Cell cell_of_tile(const View& view, int px0, int py0, int px1, int py1, double near, double far);

// Euclidean distance, 0 inside. Exact to a few roundings of the point's distance from the eye.
double distance_to_cell(const Cell& cell, const glm::dvec3& point);

// Tangent counts as touching. As exact as distance_to_cell: compare with a margin of about 1e-14 of the
// coordinates.
bool sphere_touches_cell(const Cell& cell, const glm::dvec3& centre, double radius);

}  // namespace lightgrid
