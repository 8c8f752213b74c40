// The light lists of the world grid (docs/techniques/world_grid.md).
#pragma once

#include "passes/common/frame.h"
#include "passes/common/light_source.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// The lists as kernels read them, with the view's rows.
struct WorldGridInCl {
  SharedWorldGrid* grid;
  cl::Buffer view;  // WorldViewParams
};

// Builds the lists if the scene's lights changed since they were built, or if the camera has moved too far
// from them. Views of one scene share them. While passes are timed they are built in each frame, so that
// building has a time.
WorldGridInCl build_world_grid(RenderView& v);

// The same for OpenGL's light loop.
LightSource from_world_grid(RenderView& v);

// The lists that the view's last frame read.
const SharedWorldGrid& built_world_grid(RenderView& v);

// The lists that the last frame read at each pixel of these depths (width * height, row 0 at the bottom).
ListedLights listed_of_world_grid(RenderView& v, const std::vector<float>& depth);

}  // namespace lightgrid
