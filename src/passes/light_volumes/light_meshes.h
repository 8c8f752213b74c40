// Closed triangle meshes that stand for what a light reaches: around the unit ball, or around a cone of it.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// Counter-clockwise triangles, seen from outside; each edge belongs to two of them.
struct LightMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint16_t> indices;
};

// The unit ball is inside; an icosahedron whose faces are cut into four `subdivisions` times.
LightMesh ball_mesh(int subdivisions);

// From -1 to 1 on each axis.
LightMesh box_mesh();

// Points within the half-angle of the +z axis, up to pi / 2, whose distance from the origin, the apex, is 1 at most.
LightMesh cone_mesh(double half_angle_rad);

// The cone of slope 1 around +z up to z = 1, for narrow cones: scaled in x and y it is that of any slope.
LightMesh pyramid_mesh();

// A triangle of clip space over the whole screen at depth 0, seen from behind. Not closed: it stands for the far side of
// a volume that holds all that is to be seen.
LightMesh everything_mesh();

}  // namespace lightgrid
