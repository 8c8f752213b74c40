// The visible surfaces of a frame, from OpenGL's depth image or from triangles that OpenCL rasterised, and
// the one way to shade them. The plan says which of the two draws (FramePlan::opengl): a technique has one
// recipe.
#pragma once

#include "passes/common/gbuffer.h"
#include "passes/common/light_source.h"
#include "passes/rasterize.h"
#include "renderer/render_view.h"

namespace lightgrid {

struct Surfaces {
  std::optional<VisibilityBuffer> visible;  // OpenCL's; with OpenGL instead image and drawn:
  DepthImage image;
  DrawList drawn;  // all that no tile's depth hides

  DepthBuffer depth;      // in OpenCL; null: only OpenGL has it so far
  bool numbered = false;  // find_shadows drew triangle numbers (shadows/triangle_numbers.h) in this frame
  std::optional<BlendedTriangles> blended;  // listed in OpenCL, where a pass before blending needed them
  SharedBuffer* surface_numbers = nullptr;  // OpenGL's surfaces' numbers, in OpenCL; null: none
  std::optional<DepthBounds> bounds;
  std::optional<TileDistances> distances;
};

// By a depth prepass, or by the rasteriser. depth_in_cl: a later pass in OpenCL reads the depth.
// with_numbers: the prepass draws the surfaces' numbers too, for tiles that have masks.
Surfaces find_surfaces(RenderView& v, bool depth_in_cl = false, bool with_numbers = false);

// The surfaces of a depth image that a pass has drawn.
Surfaces surfaces_of(RenderView& v, const DepthImage& image, bool depth_in_cl = false);

// Where lights cast shadows, both of these find them too (passes/find_shadows.h). For other surfaces, before
// they are shaded:
void find_shadows(RenderView& v, Surfaces& surfaces);

// Each is made at its first use in the frame.
const DepthBuffer& depth_of(RenderView& v, Surfaces& surfaces);
const DepthBounds& bounds_of(RenderView& v, Surfaces& surfaces);
const TileDistances& distances_of(RenderView& v, Surfaces& surfaces);
// The bounds for the culler: where MaskPlan::tiles is set, with the masks of opaque surfaces.
DepthBounds cull_bounds_of(RenderView& v, Surfaces& surfaces);

// The geometry buffer, and the surfaces if there are none yet: OpenGL then finds their depth while it fills
// the buffer, unless directional lights, which fill its image, need their shadows first.
GBuffer fill_gbuffer(RenderView& v, std::optional<Surfaces>& surfaces);
// The numbers of its surfaces' masks, to OpenCL, if OpenGL drew any.
void hand_over(RenderView& v, const GBuffer& gbuffer, Surfaces& surfaces);

// A frame of these surfaces, without an image yet.
Frame frame_of(RenderView& v, const Surfaces& surfaces);

// The image of opaque surfaces under these lights.
ShadedImage shade(RenderView& v, const Surfaces& surfaces, const LightSource& lights);

// Blends blended surfaces over the frame's image.
void blend(RenderView& v, const Surfaces& surfaces, const LightSource& lights, const ShadedImage& image);

}  // namespace lightgrid
