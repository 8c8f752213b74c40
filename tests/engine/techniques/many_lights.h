// A small scene with lights enough that lists get long.
#pragma once

#include <random>

#include "support/small_scene.h"

namespace lightgrid {

// 90 lights of different brightness and range among the wall and the ball, some of them behind the eye.
inline Scene many_lights() {
  Scene scene = small_scene(false).scene;
  std::mt19937 random(20261127);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * double(random() % 10000) / 1e4;
  };
  for (int i = 0; i < 90; ++i) {
    add_point(scene, "lamp", {uniform(-2, 2), uniform(-2, 2), uniform(-4.5, 0.5)}, {1, 0.9f, 0.8f},
              float(uniform(0.1, 5)), float(uniform(0.4, 3)));
  }
  return scene;
}

// Blended surfaces have a grid of their own, or the same lists as objects.
inline Scene with_glass() {
  SmallScene s{many_lights()};
  s.wall_material = 0;
  s.ball_material = 1;
  add_pane_before_wall(s, 0.4f);
  return s.scene;
}

}  // namespace lightgrid
