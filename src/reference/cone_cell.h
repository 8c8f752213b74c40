// Whether a spotlight's sector meets a cell, in closed form, for half-angles from 0 to 180 degrees.
#pragma once

#include "reference/cell.h"

namespace lightgrid {

enum class Touch { no, unsure, yes };

// The closed sector is {apex + t u : 0 <= t <= radius, angle(u, axis) <= acos(cos_outer)}, u and axis unit;
// the radius and the cell's far may be infinite. `no` and `yes` are certain. `unsure` is returned only if
// changing the half-angle by 1e-8 and the radius by 1e-9 of itself changes the result, or if the apex is
// nearer to the cell than 1e-5 of its distance from the eye. A negative or NaN radius meets nothing.
Touch cone_touches_cell(const Cell& cell, const glm::dvec3& apex, const glm::dvec3& axis, double cos_outer,
                        double radius);

}  // namespace lightgrid
