// The values that the passes of one frame pass on to each other, created anew in each frame.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/bindings.h"
#include "renderer/render_view.h"

namespace lightgrid {

// Nearest opaque surfaces: reversed 32-bit float depth, 1 at the near plane, 0 for background.
struct DepthImage {
  GLuint framebuffer = 0;  // without colour
};

// The same in OpenCL's memory: row 0 at the bottom, 32-bit float.
struct DepthBuffer {
  cl::Buffer values;
};

// The nearest opaque triangle of each pixel by its number: those of these instances one after the
// other. Until the view's next look().
struct TriangleBuffer {
  cl::Buffer numbers;
  std::span<const int> instances;  // of the scene
};

// A light grid as OpenGL's shaders read it: as lists, or as masks.
struct GridTextures {
  GLuint cells = 0, indices = 0;  // buffer textures
  GLuint masks = 0;
  GLuint z_bins = 0;  // a word a light, if the plan has z-bins
  size_t bytes = 0;
};

// For each pixel the packed indices of its lights, with the parameters that shaders/lights/lidr.glsl needs.
struct LightIndexImages {
  std::vector<GLuint> images;
  std::vector<std::string> defines;
  size_t bytes = 0;
};

struct ShadedImage {
  GLuint framebuffer = 0;         // linear RGBA, 32-bit float
  SharedBuffer* in_cl = nullptr;  // set if the final image is only in this buffer, row 0 at the bottom; the
                                  // framebuffer is then stale
};

// A technique's result, for readers of the frame: the image, input of the oracle, memory figures.
struct Frame {
  ShadedImage image;
  std::optional<LightGrid> grid;        // of opaque surfaces, in RenderView::opaque_grid()
  std::optional<LightGrid> blend_grid;  // of blended ones, in RenderView::blend_grid()
  size_t light_index_bytes = 0;         // of LightIndexImages
  size_t world_grid_bytes = 0;          // of WorldGrid's lists
  std::optional<double> world_cell;     // the value of world-cell that they were built with
  std::optional<DepthBuffer> depth;     // of techniques that rasterise in OpenCL; else the depth image has it
  std::optional<TriangleBuffer> triangles;  // of the same techniques

  size_t light_grid_bytes() const;  // of all these, in use
};

}  // namespace lightgrid
