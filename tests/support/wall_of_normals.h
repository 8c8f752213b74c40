// A surface that shows every normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "support/small_scene.h"

namespace lightgrid {

// A square wall of columns x columns small squares, 2 m before the eye and from -half_m to half_m, each with
// a normal of its own: all directions evenly, even those that no rasterised surface shows to the eye. Its
// material is the scene's only one.
inline Scene wall_of_normals(int columns, float half_m) {
  Mesh mesh;
  const float step = 2 * half_m / float(columns);
  for (int i = 0; i < columns * columns; ++i) {
    shapes::add_quad(mesh, {-half_m + step * float(i % columns), -half_m + step * float(i / columns), -2},
                     {step, 0, 0}, {0, step, 0});
    // A spiral of equal areas (Vogel, "A Better Way to Construct the Sunflower Head", 1979).
    const double z = 1 - (2 * i + 1.0) / (columns * columns), turn = 2.399963229728653 * i,
                 r = std::sqrt(1 - z * z);
    const glm::vec3 normal(glm::dvec3(r * std::cos(turn), r * std::sin(turn), z));
    std::fill(mesh.normals.end() - 4, mesh.normals.end(), normal);
  }
  Scene scene;
  const int material = add_material(scene, "colors", {0.25f, 0.5f, 0.75f}, 0.6f, 0.4f);
  add_instance(scene, "wall", add_mesh(scene, shapes::finished(std::move(mesh), "wall", material)));
  return scene;
}

}  // namespace lightgrid
