// A camera and an image size: the whole view as culling sees it. Metres; distances are along the view axis, d
// = -z.
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
  // For column vectors, m[column][row] as in GLM; view space is right-handed and looks along -z; clip depth
  // is zero to one (Vulkan's and Direct3D's, or OpenGL's after glClipControl). The matrix decides whether the
  // view is orthographic, whether its depth is reversed (near 1, far 0: Reed, "Depth Precision Visualized",
  // 2015) or standard, and whether its far plane is infinite. Off-centre projections are allowed, and oblique
  // near planes (mirrors, portals) in perspective.
  glm::dmat4 clip_from_view{1};
  glm::dmat4 view_from_world{1};     // rigid; its translation is not used
  glm::dvec3 eye{0};                 // world, metres
  std::vector<float> slice_edges;    // inner edges of the depth slices, metres, ascending; empty: one slice.
                                     // The first slice begins at the eye, the last has no end.
  std::vector<float> z_bin_edges{};  // likewise for z-bins, by which shading skips lights; empty: none
};

// The inner edges, ascending, of `slices` slices between two finite distances near_m < far_m: slices - 1
// values. near_m and far_m are no edges, so that every distance has a slice. Exponential (Olsson, Billeter,
// Assarsson, "Clustered Deferred and Forward Shading", HPG 2012) needs near_m > 0; in an orthographic view
// with near_m <= 0, far_m / 1000 replaces it, and if everything is behind the eye slices are linear.
std::vector<float> slice_edges(SliceSpacing spacing, int slices, double near_m, double far_m);

// The view's edges as depth keys, ascending, then infinity: shading compares a pixel's depth key with them
// (shared/slices.h). Each differs from its edge by one rounding of a depth; the kernels' slices end at the
// keys.
std::array<float, MOST_SLICES> slice_keys(const CullView& view);
std::array<float, MOST_Z_BINS> z_bin_keys(const CullView& view);
// Metres along the view axis, exact up to roundings in double. Infinite at and past an infinite far plane.
double distance_of_key(const CullView& view, double key);
float depth_key(const CullView& view, float depth);

// Throws Error(input) that names the number: a size below 1 or past 32,000 tiles a side; a matrix or an eye
// that is not finite; a projection that is not along -z or that culling does not support (shear, tilted w
// row, perspective with a translation, orthographic with an oblique near plane); slices or z-bins with an
// oblique near plane; a perspective near plane nearer than 10^-37 m or farther than 10^15 m, or an
// orthographic view with a side past 10^15 m; a view_from_world that is not rigid; edges of slices or z-bins
// that do not ascend, are not finite, are not in front of a perspective view's eye, or are more than
// MOST_SLICES - 1 or MOST_Z_BINS - 1. docs/hard_cases.md#the-domain
void check_view(const CullView& view, int tile);

// The view as shaders read it (lights and ambient are left 0) and as kernels read it, for tiles of `tile` x
// `tile` pixels from the lower left. Tile counts are rounded up to cover the image. Call check_view first.
ViewParams view_params(const CullView& view, int tile);
CullParams cull_params(const CullView& view, int tile);

// Properties of the view's depth, derived from clip_from_view.
bool is_orthographic(const CullView& view);
bool has_standard_depth(const CullView& view);  // near 0, far 1
double near_distance(const CullView& view);     // near plane's, metres; negative if an orthographic one
                                                // lies behind the eye

}  // namespace lightgrid
