// View-space positions from a depth buffer, in double.
#pragma once

#include <vector>

#include "scene/camera.h"

namespace lightgrid::lab {

// The view-space point at the centre of pixel (px, py), row 0 at the bottom, with depth-buffer value `depth`
// (reversed, zero to one). For orthographic and perspective projections, off-centre and oblique ones
// included. Depth 0 gives a point at infinity if the far plane is infinite.
glm::dvec3 position_from_depth(const View& view, int px, int py, double depth);

// x / -z, or x itself in an orthographic view, of a point that projects to `px` (pixel edges are integers, so
// a pixel's centre is px + 0.5); likewise for y.
double view_x_of_pixel(const View& view, double px);
double view_y_of_pixel(const View& view, double py);

// Indices (y * width + x) of the covered pixels: depth > 0, so neither background nor NaN.
std::vector<uint32_t> covered_pixels(const std::vector<float>& depth);

}  // namespace lightgrid::lab
