// The images of one material, and the masonry that hall and street share.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

struct SurfaceMaps {
  Bitmap color, normal, roughness;  // roughness may be empty
};

// Repeating every `metres`.
void use_maps(Scene& scene, int material, SurfaceMaps maps, float metres);
void use_color(Scene& scene, int material, Bitmap color, float metres);

struct Masonry {
  const char* name;
  int columns, rows;  // pieces across and up the image; each second row shifted by half a piece
  float joint_px;
  glm::vec3 color, mortar;
  float depth_px;  // of the joints
  uint64_t seed;
};

// Blocks or bricks, each with its own shade.
SurfaceMaps masonry(const Masonry& masonry);

}  // namespace lightgrid
