// The lights that certainly touch a cell of the light grid, and those that possibly do under a cull test: in
// double, by the oracle.
#pragma once

#include <vector>

#include "reference/cell.h"
#include "verify/views.h"

namespace lightgrid::verify {

// View space. A cone of -1 means none: the sphere alone.
struct OracleLight {
  glm::dvec3 position;
  glm::dvec3 axis;
  double radius, cos_outer;
  double position_error;  // of its position in float, which the culler stores relative to the median of all
                          // lights' positions
  double cone_error;      // the largest of these over all spots, added as slack to every cone
  bool lists_nothing;     // radius or position is NaN, or the radius is negative
};
std::vector<OracleLight> oracle_lights(const CullView& view, std::span<const CullLight> lights);

// Of the lights' positions, each axis alone; positions that are not finite are left out. World, metres.
glm::dvec3 median_light(std::span<const CullLight> lights);

// Of a tile and a slice; empty (near > far) if it contains nothing. Its sides go through pixels' centres,
// because nothing else is shaded, or around whole pixels.
Cell cell_of(const CullView& view, int tile, size_t index, const DepthInterval& bounds, bool pixel_centres);

bool certainly_touches(const Cell& cell, const OracleLight& light);

// A cheap sufficient test for being outside; never true of a light that certainly touches.
bool clearly_apart(const Cell& cell, const OracleLight& light);

// Inside the region that the cull test covers, widened by its float error (docs/hard_cases.md#slack). `exact`
// covers the cell itself if no slope of the view exceeds 2, else the intersection of planes and box.
bool possibly_touches(const CullView& view, int tile, const Cell& cell, const OracleLight& light,
                      CullTest test);

// The lights that certainly touch each cell, ascending.
using Touching = std::vector<std::vector<uint32_t>>;
Touching touching_lights(const CullView& view, std::span<const OracleLight> lights,
                         std::span<const DepthInterval> bounds, int tile, bool pixel_centres);

}  // namespace lightgrid::verify
