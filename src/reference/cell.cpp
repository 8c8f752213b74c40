#include "reference/cell.h"

#include <algorithm>
#include <cmath>

#include "reference/position.h"

namespace lightgrid {

namespace {

double distance_to_range(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

// To the cell's cross-section at one depth, which is a rectangle.
double distance_at_depth(const Cell& cell, const glm::dvec3& p, double depth) {
  const double scale = cell.scale_at(depth);
  return std::hypot(distance_to_range(p.x, cell.x0 * scale, cell.x1 * scale),
                    distance_to_range(p.y, cell.y0 * scale, cell.y1 * scale), -p.z - depth);
}

}  // namespace

Cell cell_of_tile(const View& view, int px0, int py0, int px1, int py1, double near, double far) {
  return {view_x_of_pixel(view, px0),
          view_x_of_pixel(view, px1),
          view_y_of_pixel(view, py0),
          view_y_of_pixel(view, py1),
          near,
          far,
          view.orthographic};
}

// The squared distance as a function of depth is convex, has a continuous slope and consists of parabolas:
// one for each choice of the sides that the point is outside of. Its minimum is at the vertex of one of the
// parabolas or at an end, so testing the nine vertices, clamped to the ends, finds it.
double distance_to_cell(const Cell& cell, const glm::dvec3& p) {
  if (cell.orthographic) return distance_at_depth(cell, p, std::clamp(-p.z, cell.near, cell.far));
  double nearest = std::numeric_limits<double>::infinity();
  for (double slope_x : {0.0, cell.x0, cell.x1}) {
    for (double slope_y : {0.0, cell.y0, cell.y1}) {
      // Vertex of (x - slope_x d)^2 [if outside in x] + (y - slope_y d)^2 [if outside in y] + (-z - d)^2. A
      // side of slope 0 adds a constant, and so does the absence of a side.
      const double bottom =
          (p.x * slope_x + p.y * slope_y - p.z) / (slope_x * slope_x + slope_y * slope_y + 1);
      nearest = std::min(nearest, distance_at_depth(cell, p, std::clamp(bottom, cell.near, cell.far)));
    }
  }
  return nearest;
}

bool sphere_touches_cell(const Cell& cell, const glm::dvec3& centre, double radius) {
  return distance_to_cell(cell, centre) <= radius;
}

}  // namespace lightgrid
