// The passes that several techniques share, in the order of a frame. Each takes its input and returns its
// output; a technique is a short sequence of them.
#pragma once

#include "base/image.h"
#include "passes/frame.h"
#include "passes/light_source.h"

namespace lightgrid {

DepthImage depth_prepass(RenderView& v);

// Copies the depth image to OpenCL.
DepthBuffer depth_to_cl(RenderView& v, const DepthImage& depth);

// An interval of distances a tile. With depth-bounds=none the buffer is not read.
DepthBounds depth_bounds(RenderView& v, const DepthBuffer& depth);
DepthBounds depth_bounds(RenderView& v, const DepthImage& depth);  // copies the image first, if it is read

// The depth bounds on the host, for culling hidden surfaces. Empty with depth-bounds=none.
TileDistances tile_distances(RenderView& v, const DepthBounds& bounds);

// The view's opaque surfaces, without those that every tile hides.
DrawList visible_surfaces(RenderView& v, const TileDistances& distances);

// The grid of opaque surfaces, or of blended ones, whose cells begin at the near plane. Kept in the view's
// storage.
LightGrid cull_lights(RenderView& v, const DepthBounds& bounds);
LightGrid cull_lights_for_blended(RenderView& v, const DepthBounds& bounds);

// Hands a grid to OpenGL.
GridTextures grid_to_gl(RenderView& v, const LightGrid& grid, SharedGridStorage& storage);

// Draws light volumes into light index images, at the prepass' depth. Throws Error(input) if no layout fits
// the settings, and Error(machine) if this machine's blending would change an index.
LightIndexImages light_index(RenderView& v);
// The lists of the last frame, for the oracle.
ListedLights read_light_index(RenderView& v);

// Shades opaque surfaces with each pixel's lights, at the prepass' depth.
ShadedImage shade_forward(RenderView& v, const DrawList& surfaces, const LightSource& lights);

// Blends blended surfaces over the image, back to front.
void shade_blended(RenderView& v, const ShadedImage& image, const LightSource& lights);

// Copies the image to the host; `image` keeps its memory from frame to frame.
void read_back(RenderView& v, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
