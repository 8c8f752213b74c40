// Draws frames and reads what they show. Code that measures or checks techniques includes this header instead
// of those of passes, renderer and techniques.
#pragma once

#include <span>
#include <vector>

#include "effects/far_light.h"
#include "passes/read_outs.h"
#include "renderer/device_clock.h"
#include "run/technique_run.h"

namespace lightgrid {

// Draws the opaque surfaces without light. Returns the depth of each sample, row 0 at the bottom. With OpenGL:
// of views with one sample per pixel.
std::vector<float> draw_depth(RenderView& v);

// Draws the opaque surfaces and finds their shadows: a frame without an image.
Frame draw_shadows(RenderView& v);

// Draws `forward` at these pixels. Others get the background. The depth image is complete afterwards.
void draw_forward_at(RenderView& v, std::span<const uint32_t> pixels, Image& image);

// The depth of the surfaces that a frame shaded, 0 for background: the technique's own where it rasterised in
// OpenCL, else the depth image.
std::vector<float> read_depth(RenderView& v, const Frame& frame);
std::vector<float> read_depth(TechniqueRun& run);  // of its last frame

// The nearest opaque triangle of a pixel.
struct MeshTriangle {
  int instance = -1;    // number in the scene; -1: none
  uint32_t number = 0;  // number in its mesh
};
// One value per pixel, for a frame that has Frame::triangles.
std::vector<MeshTriangle> read_mesh_triangles(const RenderView& v, const Frame& frame);
std::vector<SceneTriangle> own_triangles(TechniqueRun& run);

std::vector<SceneTriangle> shown_triangles(TechniqueRun& run);  // of every technique

}  // namespace lightgrid
