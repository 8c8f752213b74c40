// Scenes of random triangles that are hard to rasterise.
#pragma once

#include <cmath>

#include "raster/drawn.h"

namespace lightgrid {

inline TriangleScene scene_of(const RasterCamera& view) {
  TriangleScene scene;
  scene.camera = view;
  scene.meshes.resize(1);
  scene.instances.push_back({.mesh = 0});
  return scene;
}

// `kind` 0: any; 1: small; 2: slivers; 3: corners on pixel centres and corners; 4: across the near plane; 5:
// huge.
inline void add_random_triangle(RandomNumbers& random, int kind, TriangleScene& scene) {
  const RasterCamera& view = scene.camera;
  const double x = random.between(-0.3, 1.3) * view.grid.width,
               y = random.between(-0.3, 1.3) * view.grid.height;
  const double reach = kind == 1 ? 3 : kind == 5 ? 1e6 : 0.6 * std::max(view.grid.width, view.grid.height);
  glm::vec3 corners[3];
  for (int k = 0; k < 3; ++k) {
    double px = x + random.between(-reach, reach), py = y + random.between(-reach, reach);
    if (kind == 2) {
      px = x + (k == 0 ? -reach : reach);
      py = y + (k == 0 ? 1 : k == 1 ? -1 : -1.01) * random.between(0, 1) * reach;
    }
    if (kind == 3) {
      px = std::round(px * 2) / 2;
      py = std::round(py * 2) / 2;
    }
    const double w = std::exp(random.between(std::log(0.1), std::log(1000.0)));
    corners[k] = at(view, px, py, kind == 3 ? std::exp2(std::round(std::log2(w)) + 1) : w);
    if (kind == 4)
      corners[k] = glm::vec3(random.between(-5, 5), random.between(-5, 5), random.between(-5, 5));
  }
  add_triangle(scene.meshes[0], corners[0], corners[1], corners[2]);
}

}  // namespace lightgrid
