#include "oracle/position.h"

namespace lightgrid::lab {

// Both kinds of projection have clip.x = P00 x + P20 z + P30; w is -z (perspective) or 1 (orthographic).
double view_x_of_pixel(const View& view, double px) {
  const glm::dmat4& clip = view.clip_from_view;
  const double ndc = 2 * px / view.width - 1;
  return (view.orthographic ? ndc - clip[3][0] : ndc + clip[2][0]) / clip[0][0];
}

double view_y_of_pixel(const View& view, double py) {
  const glm::dmat4& clip = view.clip_from_view;
  const double ndc = 2 * py / view.height - 1;
  return (view.orthographic ? ndc - clip[3][1] : ndc + clip[2][1]) / clip[1][1];
}

glm::dvec3 position_from_depth(const View& view, int px, int py, double depth) {
  const glm::dmat4& clip = view.clip_from_view;
  const double x = view_x_of_pixel(view, px + 0.5), y = view_y_of_pixel(view, py + 0.5);
  // The x and y terms of the depth row are nonzero only for an oblique near plane.
  const double tilt = clip[0][2] * x + clip[1][2] * y;
  if (view.orthographic) return {x, y, (depth - tilt - clip[3][2]) / clip[2][2]};
  const double distance = clip[3][2] / (depth + clip[2][2] - tilt);
  return {x * distance, y * distance, -distance};
}

std::vector<uint32_t> covered_pixels(const std::vector<float>& depth) {
  std::vector<uint32_t> pixels;
  for (size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] > 0) pixels.push_back(uint32_t(i));
  }
  return pixels;
}

}  // namespace lightgrid::lab
