// Closed triangle meshes that enclose the reach of a light: the unit sphere, or a cone of it.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// Counter-clockwise triangles, seen from outside; each edge belongs to two of them.
struct LightMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint16_t> indices;
};

// Encloses the unit sphere; an icosahedron whose faces are cut into four `subdivisions` times.
LightMesh ball_mesh(int subdivisions);

// From -1 to 1 on each axis.
LightMesh box_mesh();

// Encloses points within the half-angle of the +z axis, up to pi / 2, at distance 1 or less from the apex,
// the origin.
LightMesh cone_mesh(double half_angle_rad);

// The cone of slope 1 around +z up to z = 1, for narrow cones: scaling x and y gives any slope.
LightMesh pyramid_mesh();

// A clip-space triangle over the whole screen at depth 0, seen from behind. Not closed: it is the far side of
// a volume that contains everything visible.
LightMesh everything_mesh();

}  // namespace lightgrid
