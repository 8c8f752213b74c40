// A small frame to write, read and damage: a sloped floor in front of a far wall, lights of every kind.
#pragma once

#include <algorithm>
#include <cmath>

#include "frames/frame_file.h"

namespace lightgrid::lab {

inline CapturedFrame small_frame(int width = 37, int height = 21) {
  CapturedFrame frame;
  frame.name = "small";
  Camera camera = look_at({3, 2, 5}, {2, 1, -4});
  camera.near_m = 0.25;
  frame.view = make_view(camera, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double slope = std::tan(camera.fov_y_rad / 2) * (2 * (y + 0.5) / height - 1);
      const double distance = slope < -0.05 ? std::min(12.0, 1.5 / -slope) : 12.0;
      frame.depth.push_back(y > height - 4 ? 0.0f : float(0.25 / distance));
    }
  }
  for (int i = 0; i < 24; ++i) {
    Light light;
    light.name = i % 5 == 0 ? "lamp \"" + std::to_string(i) + "\"" : "";
    light.type = i % 7 == 6 ? LightType::directional : i % 3 == 2 ? LightType::spot : LightType::point;
    light.position = {3.5 - 0.3 * i, 0.25 + 0.1 * i, 2.0 - 0.4 * i};
    light.direction = glm::normalize(glm::vec3(0.1f * i - 1, -1, 0.3f));
    if (i != 3) light.radius_m = 0.8f + 0.1f * i;
    light.outer_cone_rad = 0.3f + 0.05f * i;
    frame.lights.push_back(light);
  }
  return frame;
}

// The same picture from an engine with standard depth: 0 at the near plane, 1 at the far one.
inline CapturedFrame with_standard_depth(CapturedFrame frame, double far_m) {
  const double near_m = frame.view.near_m;
  frame.view.far_m = far_m;
  glm::dmat4& clip = frame.view.clip_from_view;
  clip[2][2] = std::isinf(far_m) ? -1 : -far_m / (far_m - near_m);
  clip[3][2] = std::isinf(far_m) ? -near_m : -far_m * near_m / (far_m - near_m);
  for (float& depth : frame.depth) {
    if (depth == 0) {
      depth = 1;
    } else {
      depth = float(clip[3][2] / (near_m / depth) - clip[2][2]);
    }
  }
  return frame;
}

}  // namespace lightgrid::lab
