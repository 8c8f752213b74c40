// Parts of scenes on which shadows are hard: for the hard cases and the hunt.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/camera.h"
#include "scene/random.h"
#include "scene/scene.h"

namespace lightgrid::lab::verify {

using ShadowTriangle = std::array<glm::vec3, 3>;
using ShadowTriangles = std::vector<ShadowTriangle>;

// Material 0 is opaque and double-sided, 1 masked by a texture of random texels, 2 blended.
Scene empty_shadow_scene();

// A mesh of three vertices a triangle, and an instance of it, which is returned. Texture coordinates are x
// and y.
Instance& add_triangles(Scene& scene, std::span<const ShadowTriangle> triangles,
                        const glm::dmat4& world_from_object = glm::dmat4(1), int material = 0);

void add_quad(ShadowTriangles& triangles, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
              int columns = 1, int rows = 1);
void add_box(ShadowTriangles& triangles, const glm::vec3& low, const glm::vec3& high);
ShadowTriangles quad_of(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, int columns = 1,
                        int rows = 1);
ShadowTriangles box_of(const glm::vec3& low, const glm::vec3& high);

// A light that casts.
Light& add_lamp(Scene& scene, const glm::dvec3& position, float radius_m = 100);
Light& add_spot_lamp(Scene& scene, const glm::dvec3& position, const glm::dvec3& target, float outer_rad,
                     float radius_m = 100);

View shadow_view(const glm::dvec3& eye, const glm::dvec3& target, int width = 64, int height = 48,
                 double fov_y_rad = 1.2);

// Uniform in a cube of this half edge.
glm::dvec3 in_cube(Random& random, double half);

// Needles as long as 3 m and 1e-6 to 0.1 m wide, about the origin.
ShadowTriangles sliver_soup(Random& random, int count);
// Triangles, each also turned round, as it is, and without area.
ShadowTriangles duplicate_soup(Random& random, int count);
// Triangles with parts of them in their planes.
ShadowTriangles coplanar_soup(Random& random, int count);
// Walls of squares beside squares half as large, about the origin.
ShadowTriangles junction_soup(Random& random, int count);
// Triangles of 1e-4 and 0.05 m among some of 1 km.
ShadowTriangles soup_of_all_sizes(Random& random, int count);

// A place on a triangle, often on an edge or at a corner.
glm::dvec3 on_triangle(Random& random, const ShadowTriangle& triangle);

}  // namespace lightgrid::lab::verify
