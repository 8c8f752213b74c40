// A material whose normal map, if any, tilts every normal up and to the right.
#pragma once

#include "support/small_scene.h"

namespace lightgrid {

// The scene's first and only material.
inline void add_tilted_material(Scene& scene, bool normal_map) {
  scene.materials.push_back({});
  scene.materials[0].metallic = 0;
  if (normal_map) {
    Bitmap bitmap;
    bitmap.width = bitmap.height = 1;
    bitmap.rgba = {170, 200, 230, 255};
    scene.materials[0].normal_map.texture = add_texture(scene, std::move(bitmap), false);
  }
}

}  // namespace lightgrid
