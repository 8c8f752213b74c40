// A technique with a rasteriser of its own beside OpenGL's: where they show different triangles, and how far
// apart the images are elsewhere.
#pragma once

#include "compare/run_technique.h"
#include "passes/read_outs.h"

namespace lightgrid {

// The triangle of each pixel in the last frame of a run that has Frame::triangles.
std::vector<SceneTriangle> own_triangles(TechniqueRun& run);

// `own` and `shown`: of each pixel of the image and of the reference. Relative to the reference's brightest
// channel.
SilhouetteError silhouette_error(const Image& image, const std::vector<SceneTriangle>& own,
                                 const Image& reference, const ShownTriangles& shown);

}  // namespace lightgrid
