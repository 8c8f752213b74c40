// Pixels whose blended surfaces are blended in a wrong order. All techniques draw blended instances back to front by
// the centres of their boxes, and the triangles of each in the mesh's order: right unless instances reach into one
// another's depths, or a mesh hides itself. By rays in double; needs no device.
#pragma once

#include <span>
#include <string>

#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::lab {

struct BlendOrder {
  uint64_t blended = 0;  // pixels with a blended surface in front of the opaque one
  uint64_t several = 0;  // of these, pixels with two or more
  uint64_t wrong = 0;    // of these, pixels where a farther one is blended over a nearer one
};

// Counts pixels by their centres. drawn: blended instances in the order in which they are drawn (SurfacePlan::blended).
BlendOrder find_blend_order(const Scene& scene, const View& view, std::span<const int> drawn);

// As `lightgrid plan` prints it.
std::string describe(const BlendOrder& order);

}  // namespace lightgrid::lab
