// The passes of a frame, in the order in which a frame runs them. Typed values in, typed values out; a technique is
// a short recipe over these.
#pragma once

#include "base/image.h"
#include "passes/frame/visible_clusters.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Nearest opaque surfaces: reversed 32-bit float depth, 1 at the near plane, 0 where nothing is.
struct DepthImage {
  GLuint framebuffer = 0;  // without colour
};

// A light grid as the shading code reads it: as lists, or as masks.
struct GridTextures {
  LightGrid grid;
  GLuint cells = 0, indices = 0;  // buffer textures
  GLuint masks = 0;
  GLuint z_bins = 0;  // of each light, where the plan has some
};

// For each pixel the indices of its lights, packed, and what shaders/lights/lidr.glsl must know to read them.
struct LightIndexImages {
  std::vector<GLuint> images;
  std::vector<std::string> defines;
  size_t bytes = 0;
};

struct ShadedImage {
  GLuint framebuffer = 0;           // linear RGBA, 32-bit float
  SharedBuffer* in_cl = nullptr;    // where OpenCL finished it, row 0 at the bottom, and the framebuffer has it not
};

DepthImage depth_prepass(Frame& f);

// The depth image as OpenCL reads it: row 0 at the bottom, 32-bit float.
cl::Buffer& depth_to_cl(Frame& f, const DepthImage& depth);

DepthBounds depth_bounds(Frame& f, const DepthImage& depth);

// What each tile hides, on the host. Nothing is known where depth bounds are switched off.
TileDistances tile_distances(Frame& f, const DepthBounds& bounds);

// The grid of opaque surfaces, or of blended ones, whose cells begin at the near plane.
GridTextures cull_lights(Frame& f, const DepthBounds& bounds);
GridTextures cull_lights_for_blended(Frame& f, const DepthBounds& bounds);

// The grid of opaque surfaces for light code in OpenCL: in f.opaque_grid(), and OpenGL does not see it unless handed it.
LightGrid cull_lights_for_cl(Frame& f, const DepthBounds& bounds);
GridTextures grid_to_gl(Frame& f, const LightGrid& grid);

// Draws light volumes into light index images, at the depth that the prepass left. Throws Error(input) where no images hold
// what the settings ask for, and Error(machine) where this machine's blending would change an index.
LightIndexImages light_index(Frame& f);
// Those of the last frame, for the oracle.
ListedLights read_light_index(Frame& f);

// Shades opaque surfaces, at the depth that the prepass left, from the grid's lists, or, without a grid, from every light.
// What `distances` shows to be hidden is not drawn.
ShadedImage shade_forward(Frame& f, const TileDistances& distances, const GridTextures* grid);
ShadedImage shade_forward(Frame& f, const TileDistances& distances, const LightIndexImages& index);

// Lays blended surfaces over the image, back to front. Without a grid: from every light.
void shade_blended(Frame& f, const ShadedImage& image, const GridTextures* grid);
void shade_blended(Frame& f, const ShadedImage& image, const LightIndexImages& index);

// Into `image`, which keeps its memory from frame to frame.
void read_back(Frame& f, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
