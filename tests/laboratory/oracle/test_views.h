// Views with round numbers, made without a camera.
#pragma once

#include "scene/camera.h"

namespace lightgrid::lab {

// half_x and half_y: x / -z and y / -z at the image's edges; the image's centre looks along (shift_x,
// shift_y, -1).
inline View perspective_view(int width, int height, double half_x, double half_y, double near_m, double far_m,
                             double shift_x = 0, double shift_y = 0) {
  View view{.width = width, .height = height, .near_m = near_m, .far_m = far_m};
  glm::dmat4& clip = view.clip_from_view = glm::dmat4(0);
  clip[0][0] = 1 / half_x;
  clip[1][1] = 1 / half_y;
  clip[2][0] = shift_x / half_x;
  clip[2][1] = shift_y / half_y;
  const bool infinite = far_m == std::numeric_limits<double>::infinity();
  clip[2][2] = infinite ? 0 : near_m / (far_m - near_m);
  clip[3][2] = infinite ? near_m : far_m * near_m / (far_m - near_m);
  clip[2][3] = -1;
  return view;
}

inline View orthographic_view(int width, int height, double half_x, double half_y, double near_m,
                              double far_m, double centre_x = 0, double centre_y = 0) {
  View view{.width = width, .height = height, .near_m = near_m, .far_m = far_m, .orthographic = true};
  glm::dmat4& clip = view.clip_from_view = glm::dmat4(1);
  clip[0][0] = 1 / half_x;
  clip[1][1] = 1 / half_y;
  clip[3][0] = -centre_x / half_x;
  clip[3][1] = -centre_y / half_y;
  clip[2][2] = 1 / (far_m - near_m);
  clip[3][2] = far_m / (far_m - near_m);
  return view;
}

}  // namespace lightgrid::lab
