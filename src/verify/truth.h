// Which lights certainly touch a cell of the light grid, and which possibly do under a cull test: in double, by the
// oracle.
#pragma once

#include <vector>

#include "reference/cell.h"
#include "verify/views.h"

namespace lightgrid::verify {

// View space. A cone of -1 is none: the sphere alone.
struct TrueLight {
  glm::dvec3 position;
  glm::dvec3 axis;
  double radius, cos_outer;
  double place_error;  // of its place in float, which the culler keeps relative to the middle of all lights' places
  double cone_error;   // the largest of these of all spots, which every cone has as slack
  bool lists_nothing;  // radius or place is no number, or the radius is negative
};
std::vector<TrueLight> true_lights(const CullView& view, std::span<const CullLight> lights);

// Of a tile and a slice; empty (near > far) where nothing is in it. Its sides go through pixels' centres, since nothing
// else is shaded, or around whole pixels.
Cell cell_of(const CullView& view, int tile, size_t index, const DepthInterval& bounds, bool pixel_centres);

bool certainly_touches(const Cell& cell, const TrueLight& light);

// A lower bound of what is outside: cheap, and never true of a light that certainly touches.
bool clearly_apart(const Cell& cell, const TrueLight& light);

// Inside the region that the cull test promises, widened by what its float arithmetic may add (docs/hard_cases.md#slack).
// `exact` promises the cell itself where no slope of the view is past 2, else what planes and box do together.
bool possibly_touches(const CullView& view, int tile, const Cell& cell, const TrueLight& light, CullTest test);

// The lights that certainly touch each cell, ascending.
using Touching = std::vector<std::vector<uint32_t>>;
Touching touching_lights(const CullView& view, std::span<const TrueLight> lights, std::span<const DepthInterval> bounds,
                         int tile, bool pixel_centres);

}  // namespace lightgrid::verify
