// The small scene with glass, a spot and many lamps, and views of it without perspective.
#pragma once

#include "support/small_scene.h"

namespace lightgrid {

inline Scene crowded_scene() {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "spot"}) effect(name).add(s);
  for (int i = 0; i < 60; ++i) {
    add_point(s.scene, "lamp", {0.05f * i - 1.5f, 0.3f, -3.9f + 0.03f * i}, {1, 1, 1}, 0.3f,
              0.2f + 0.01f * i);
  }
  return s.scene;
}

inline View orthographic_view(double near_m) {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.orthographic = true;
  camera.half_width_m = camera.half_height_m = 2;
  camera.near_m = near_m;
  camera.far_m = 10;
  return make_view(camera, 127, 73);
}

}  // namespace lightgrid
