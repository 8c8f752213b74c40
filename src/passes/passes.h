// The passes that several techniques share, in the order in which a frame runs them. Each takes what it reads and returns
// what it made; a technique is a short recipe over these.
#pragma once

#include "base/image.h"
#include "passes/frame.h"
#include "passes/light_source.h"

namespace lightgrid {

DepthImage depth_prepass(RenderView& v);

// A copy of the depth image for OpenCL.
DepthBuffer depth_to_cl(RenderView& v, const DepthImage& depth);

// An interval of distances a tile. Without depth bounds the buffer is not read.
DepthBounds depth_bounds(RenderView& v, const DepthBuffer& depth);
DepthBounds depth_bounds(RenderView& v, const DepthImage& depth);  // copies the image first, where it is read

// What each tile hides, on the host. Nothing is known where depth bounds are switched off.
TileDistances tile_distances(RenderView& v, const DepthBounds& bounds);

// The opaque surfaces of the view that no tile hides.
DrawList visible_surfaces(RenderView& v, const TileDistances& distances);

// The grid of opaque surfaces, or of blended ones, whose cells begin at the near plane. In the view's storage, for OpenCL.
LightGrid cull_lights(RenderView& v, const DepthBounds& bounds);
LightGrid cull_lights_for_blended(RenderView& v, const DepthBounds& bounds);

// Hands a grid to OpenGL.
GridTextures grid_to_gl(RenderView& v, const LightGrid& grid, SharedGridStorage& storage);

// Draws light volumes into light index images, at the depth that the prepass left. Throws Error(input) where no images hold
// what the settings ask for, and Error(machine) where this machine's blending would change an index.
LightIndexImages light_index(RenderView& v);
// Those of the last frame, for the oracle.
ListedLights read_light_index(RenderView& v);

// Shades opaque surfaces with each pixel's lights, at the depth that the prepass left.
ShadedImage shade_forward(RenderView& v, const DrawList& surfaces, const LightSource& lights);

// Lays blended surfaces over the image, back to front.
void shade_blended(RenderView& v, const ShadedImage& image, const LightSource& lights);

// Into `image`, which keeps its memory from frame to frame.
void read_back(RenderView& v, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
