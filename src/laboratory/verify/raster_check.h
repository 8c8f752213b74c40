// Shared by hard cases of rasterising: scenes of few triangles, and the comparison with the coverage oracle.
#pragma once

#include <optional>

#include "verify/check.h"

namespace lightgrid::verify {

// A view from the origin whose clip space is (x, y, 0.1, -z): x = y = -z is the image's upper right corner.
inline RasterInput raster_scene(int width, int height, bool two_sided = false) {
  RasterInput input;
  input.camera = {.grid = {width, height}, .clip_from_view = glm::dmat4(0)};
  glm::dmat4& m = input.camera.clip_from_view;
  m[0][0] = m[1][1] = 1, m[2][3] = -1, m[3][2] = 0.1;
  input.meshes.resize(1);
  input.instances = {{.two_sided = two_sided}};
  return input;
}

// The place that the view shows at pixel (x, y) and distance d.
inline glm::vec3 raster_position(const RasterInput& input, double x, double y, double d) {
  return {float((2 * x / input.camera.grid.width - 1) * d), float((2 * y / input.camera.grid.height - 1) * d),
          float(-d)};
}

inline void add_raster_triangle(RasterInput& input, const glm::vec3& a, const glm::vec3& b,
                                const glm::vec3& c) {
  RasterInputMesh& mesh = input.meshes[0];
  for (const glm::vec3& p : {a, b, c}) {
    mesh.indices.push_back(uint32_t(mesh.positions.size()));
    mesh.positions.push_back(p);
  }
}

// Three corners, one after the other.
template <typename Corner>
void add_raster_triangle(RasterInput& input, const Corner& corner) {
  const glm::vec3 a = corner(), b = corner(), c = corner();
  add_raster_triangle(input, a, b, c);
}

// Compares each sample of each pixel with the oracle, and the bytes of every shape with each other. Returns
// the first image, or nothing where the engine culls only.
std::optional<RasterImage> raster(Check& c, const RasterInput& input);

}  // namespace lightgrid::verify
