// Sides of surfaces under a linear map, for maps that flatten too. A map is singular if its determinant is no
// larger than the rounding of a product of some matrices: its sign then says nothing.
#pragma once

#include <glm/mat3x3.hpp>

namespace lightgrid {

bool is_singular(const glm::dmat3& to_from_object);
// A negative determinant: front faces are clockwise in the image. A singular map never mirrors.
bool is_mirroring(const glm::dmat3& to_from_object);

// Maps normals, up to a positive factor, to the side from which front faces are seen: counter-clockwise, or
// clockwise if `mirrored`. A map onto a plane gives the plane's normal, or 0 for surfaces that it maps to
// lines; a map onto a line or a point gives 0 for all. Elements stay far from the ends of float's range.
glm::dmat3 normal_matrix(const glm::dmat3& to_from_object, bool mirrored);

}  // namespace lightgrid
