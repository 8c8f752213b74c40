// Cells: the convex parts of view space within a tile and a range of depths, their exact distance to a point,
// and the lights that certainly or possibly touch one.
#pragma once

#include <span>

#include "scene/camera.h"
#include "shared/cull_settings.h"

namespace lightgrid::lab {

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

// The cell between two corners in pixels, row 0 at the bottom; handles off-centre projections.
Cell cell_of_pixels(const View& view, double px0, double py0, double px1, double py1, double near,
                    double far);

// Euclidean distance, 0 inside. Exact to a few roundings of the point's distance from the eye.
double distance_to_cell(const Cell& cell, const glm::dvec3& point);

// Tangent counts as touching. As exact as distance_to_cell: compare with a margin of about 1e-14 of the
// coordinates.
bool sphere_touches_cell(const Cell& cell, const glm::dvec3& centre, double radius);

// The largest of the signed distances to the cell's side planes, outside positive, metres.
double outside_of_sides(const Cell& cell, const glm::dvec3& point);

// The view-space box around a cell, and the sphere around the box; d = -z.
struct CellBox {
  double x0, x1, y0, y1, d0, d1;
  glm::dvec3 centre() const;
  double radius() const;
  double distance(const glm::dvec3& point) const;
};
CellBox box_around(const Cell& cell);

// Decides in closed form whether a spotlight's sector meets a cell, for half-angles from 0 to 180 degrees.
enum class Touch { no, unsure, yes };

// The closed sector is {apex + t u : 0 <= t <= radius, angle(u, axis) <= acos(cos_outer)}, u and axis unit;
// the radius and the cell's far may be infinite. `no` and `yes` are certain. `unsure` is returned only if
// changing the half-angle by 1e-8 and the radius by 1e-9 of itself changes the result, or if the apex is
// nearer to the cell than 1e-5 of its distance from the eye. A negative or NaN radius meets nothing.
Touch cone_touches_cell(const Cell& cell, const glm::dvec3& apex, const glm::dvec3& axis, double cos_outer,
                        double radius);

// View space. A cone of -1 means none: the sphere alone.
struct OracleLight {
  glm::dvec3 position;
  glm::dvec3 axis;
  double radius, cos_outer = -1;
  double position_error = 0;   // of its position in float, which the culler stores relative to the median of
                               // all lights' positions
  double cone_error = 0;       // the largest of these over all spots, added as slack to every cone
  bool lists_nothing = false;  // radius or position is NaN, or the radius is negative
};

// The cell of a tile and a slice, whose surfaces lie between near and far, metres along the view axis; empty
// (near > far) if it contains nothing. Its sides go through pixels' centres, because nothing else is shaded,
// or around whole pixels.
Cell cell_of_grid(const View& view, int tile, std::span<const float> slice_edges, size_t index, double near,
                  double far, bool pixel_centres);

bool certainly_touches(const Cell& cell, const OracleLight& light);

// A cheap sufficient test for being outside; never true of a light that certainly touches.
bool clearly_apart(const Cell& cell, const OracleLight& light);

// Inside the region that the cull test covers, widened by its float error (docs/hard_cases.md#slack). `exact`
// covers the cell itself if no slope of the view exceeds 2, else the intersection of planes and box.
bool possibly_touches(const View& view, int tile, const Cell& cell, const OracleLight& light, CullTest test);

}  // namespace lightgrid::lab
