// A camera and an image size: all that culling knows of the viewer. Metres; distances are along the view axis, d = -z.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "shared/cull_params.h"
#include "shared/cull_settings.h"
#include "shared/slices.h"
#include "shared/view_params.h"

namespace lightgrid {

struct CullView {
  int width = 0, height = 0;  // pixels
  // For column vectors, m[column][row] as GLM has it; view space is right-handed and looks along -z; clip depth is zero
  // to one (Vulkan's and Direct3D's, or OpenGL's after glClipControl). Whether the view is orthographic, its depth
  // reversed (near 1, far 0: Reed, "Depth Precision Visualized", 2015) or standard, and its far plane infinite is read
  // off the matrix; off-centre projections and, in perspective, oblique near planes (mirrors, portals) included.
  glm::dmat4 clip_from_view{1};
  glm::dmat4 view_from_world{1};   // rigid; its translation is not used
  glm::dvec3 eye{0};               // world, metres
  std::vector<float> slice_edges;  // inner edges of the depth slices, metres, ascending; empty: one slice. The first
                                   // slice begins at the eye, the last has no end.
  std::vector<float> z_bin_edges{};  // likewise of z-bins, by which shading passes over lights; empty: none
};

// The slices - 1 inner edges, ascending, of `slices` slices between two distances near_m < far_m, both finite; near and
// far themselves are none, so that every distance has a slice. Exponential (Olsson, Billeter, Assarsson, "Clustered
// Deferred and Forward Shading", HPG 2012) wants near_m > 0: where it is not, in an orthographic view, far_m / 1000 stands
// for it, and where all is behind the eye slices are linear.
std::vector<float> slice_edges(SliceSpacing spacing, int slices, double near_m, double far_m);

// What shading compares a pixel's depth key with (shared/slices.h): the view's edges as depth keys, ascending, then
// infinity. Each differs from its edge by one rounding of a depth; the kernels' slices end where the keys lie.
std::array<float, MOST_SLICES> slice_keys(const CullView& view);
std::array<float, MOST_Z_BINS> z_bin_keys(const CullView& view);
// Metres along the view axis, exact but for roundings in double. Infinite at and past an infinite far plane.
double distance_of_key(const CullView& view, double key);
float depth_key(const CullView& view, float depth);

// Throws Error(input) that names the number: a size below 1 or past 32,000 tiles a side; a matrix or an eye that is not
// finite; a projection that is not along -z or that culling cannot do (shear, tilted w row, perspective with a
// translation, orthographic with an oblique near plane); slices or z-bins with an oblique near plane; a perspective near
// plane nearer than 10^-37 m or farther than 10^15 m, or an orthographic view with a side past 10^15 m; a view_from_world
// that is not rigid; edges of slices or z-bins that do not ascend, are not finite, are not in front of a perspective
// view's eye, or are more than MOST_SLICES - 1 or MOST_Z_BINS - 1. docs/hard_cases.md#the-domain
void check_view(const CullView& view, int tile);

// The view in the numbers of shaders (lights and ambient are left 0) and of kernels, for tiles of `tile` x `tile`
// pixels from the lower left. Tile counts are rounded up to cover the image. Call check_view first.
ViewParams view_params(const CullView& view, int tile);
CullParams cull_params(const CullView& view, int tile);

// What a depth value means in this view, read off clip_from_view.
bool is_orthographic(const CullView& view);
bool has_standard_depth(const CullView& view);   // near 0, far 1
double near_distance(const CullView& view);      // metres, of the near plane; where an orthographic one lies behind the
                                                 // eye, negative

}  // namespace lightgrid
