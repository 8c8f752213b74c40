// Parametric shapes as indexed triangles with normals, tangents and texture coordinates in metres.
//
// Every shape is patches of a surface P(s, t) whose normal is dP/ds x dP/dt. u grows with s and v falls with
// t, in metres, so that an image stands upright with t up; the tangent is dP/ds, handedness +1 (glTF's
// bitangent, cross(normal, tangent) * w, is then dP/dt). Triangles are counter-clockwise about the normal.
#pragma once

#include <span>

#include <glm/gtc/constants.hpp>

#include "scene/scene.h"

namespace lightgrid::shapes {

struct SurfacePoint {
  glm::vec3 position, normal, tangent;  // tangent along increasing u; need not be exactly orthogonal or unit
  glm::vec2 uv;
};

// A grid of (columns + 1) x (rows + 1) points, row by row, each row along s; triangles without area are
// omitted.
void add_grid(Mesh& mesh, int columns, int rows, std::span<const SurfacePoint> points);

// A parallelogram: s along `right`, t along `up`; texture origin at `corner`.
void add_quad(Mesh& mesh, glm::vec3 corner, glm::vec3 right, glm::vec3 up, int columns = 1, int rows = 1);

// All six sides, outward.
void add_box(Mesh& mesh, glm::vec3 low, glm::vec3 high);

// The flat strip between two polylines of equal length, s along them and t from `lower` to `upper`; all
// points lie in the plane with the given normal. `right` is the direction of u, perpendicular to the normal.
void add_strip(Mesh& mesh, std::span<const glm::vec3> lower, std::span<const glm::vec3> upper,
               glm::vec3 normal, glm::vec3 right);

// A polyline swept along `sweep`: s along the polyline, t along the sweep. Smooth: one normal a point, else
// one a segment.
void add_sweep(Mesh& mesh, std::span<const glm::vec3> line, glm::vec3 sweep, bool smooth);

// A profile (radius, height) turned about the y axis through `center`, outward where the profile climbs. A
// profile point repeated is a sharp edge; between sharp edges the profile is smooth.
void add_lathe(Mesh& mesh, glm::vec3 center, std::span<const glm::vec2> profile, int sides);

// A cube's grid pushed out to the sphere: no poles. Texture coordinates run over each face.
void add_sphere(Mesh& mesh, glm::vec3 center, float radius, int cells_per_edge);

// A ring about `axis` (unit).
void add_torus(Mesh& mesh, glm::vec3 center, glm::vec3 axis, float ring_radius, float tube_radius, int sides,
               int tube_sides);

// Points of an arc in the plane of `right` and `up`, from angle `from` to `to` (radians, 0 along right).
std::vector<glm::vec3> arc(glm::vec3 center, glm::vec3 right, glm::vec3 up, float from, float to,
                           int segments);

// Sets the bounds; call it last for every mesh.
Mesh finished(Mesh mesh, std::string name, int material);

}  // namespace lightgrid::shapes
