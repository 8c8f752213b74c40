// Which meshes of a scene are uploaded.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// By mesh: whether an instance shows it, and it has triangles. OpenGL's and OpenCL's copies of a scene, and
// the rasteriser's, leave out the others: their vertices are numbered alike.
std::vector<bool> shown_meshes(const Scene& scene);

}  // namespace lightgrid
