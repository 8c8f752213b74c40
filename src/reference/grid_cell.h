// Cells of a light grid against lights: those that certainly touch a cell, and those that possibly do under a
// cull test.
#pragma once

#include <span>

#include "reference/cell.h"
#include "shared/cull_settings.h"

namespace lightgrid {

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

// The largest of the signed distances to the cell's side planes, outside positive; and the distance to the
// view-space box around the cell. Metres.
double outside_of_sides(const Cell& cell, const glm::dvec3& point);
double distance_to_box_of(const Cell& cell, const glm::dvec3& point);

}  // namespace lightgrid
