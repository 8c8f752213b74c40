// What the passes of one frame hand to each other: values, made anew in each frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/render_view.h"

namespace lightgrid {

// Nearest opaque surfaces: reversed 32-bit float depth, 1 at the near plane, 0 where nothing is.
struct DepthImage {
  GLuint framebuffer = 0;  // without colour
};

// The same in OpenCL's memory: row 0 at the bottom, 32-bit float.
struct DepthBuffer {
  cl::Buffer values;
};

// A light grid as shading code in OpenGL reads it: as lists, or as masks.
struct GridTextures {
  GLuint cells = 0, indices = 0;  // buffer textures
  GLuint masks = 0;
  GLuint z_bins = 0;  // of each light, where the plan has some
  size_t bytes = 0;
};

// For each pixel the indices of its lights, packed, and what shaders/lights/lidr.glsl must know to read them.
struct LightIndexImages {
  std::vector<GLuint> images;
  std::vector<std::string> defines;
  size_t bytes = 0;
};

struct ShadedImage {
  GLuint framebuffer = 0;         // linear RGBA, 32-bit float
  SharedBuffer* in_cl = nullptr;  // set if the final image is in this buffer alone, row 0 at the bottom; the framebuffer is
                                  // then stale
};

// What a technique made, for what reads the frame afterwards: the image, the oracle, figures of memory.
struct Frame {
  ShadedImage image;
  std::optional<LightGrid> grid;        // of opaque surfaces, in RenderView::opaque_grid()
  std::optional<LightGrid> blend_grid;  // of blended ones, in RenderView::blend_grid()
  size_t light_index_bytes = 0;         // of LightIndexImages

  size_t light_grid_bytes() const;  // of all these, in use
};

}  // namespace lightgrid
