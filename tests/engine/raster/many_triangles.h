// Triangles of every size, for tests of the rasteriser.
#pragma once

#include <cmath>

#include "raster/drawn.h"

namespace lightgrid {

// Some are thousands of pixels wide; in three instances.
inline TriangleScene many_triangles(int count, int width, int height, uint32_t seed) {
  RandomNumbers random(seed);
  TriangleScene scene;
  scene.camera = plain_view(width, height);
  scene.meshes.resize(3);
  for (int i = 0; i < count; ++i) {
    const double x = random.between(-0.1, 1.1) * width, y = random.between(-0.1, 1.1) * height;
    const double reach = std::exp(random.between(-1, std::log(i % 50 == 0 ? 1000.0 : 20.0))),
                 w = random.between(1, 5);
    const auto corner = [&] {
      return at(scene.camera, x + random.between(-reach, reach), y + random.between(-reach, reach),
                w + random.between(-0.5, 0.5));
    };
    const glm::vec3 a = corner(), b = corner(), c = corner();
    add_triangle(scene.meshes[i % 3], a, b, c);
  }
  for (int m = 0; m < 3; ++m) scene.instances.push_back({.mesh = m, .two_sided = m == 1});
  return scene;
}

}  // namespace lightgrid
