// Triangles to rasterise, and what came out, as hard cases of the rasteriser have them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "raster/raster_view.h"

namespace lightgrid::verify {

struct RasterInputMesh {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
};

struct RasterInput {
  RasterCamera camera;
  std::vector<RasterInputMesh> meshes;
  std::vector<RasterInstance> instances;
};

struct RasterImage {
  std::vector<uint32_t> triangles;  // a pixel, row 0 at the bottom
  std::vector<float> depths;
  std::vector<std::vector<glm::vec4>> clip;  // of each instance, its vertices in clip space
  uint64_t invalid_triangles = 0;
};

}  // namespace lightgrid::verify
