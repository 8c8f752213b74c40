// The light buffer of light_prepass from the light lists of tiles, in OpenCL.
#pragma once

#include "passes/common/light_buffer.h"

namespace lightgrid {

// A copy of OpenGL's image.
NormalsInCl normals_to_cl(PassContext& work, const NormalImage& normals);

// The sums over the lights of the pixel's cell, rounded once. use: gbuffer where they are not copied to
// OpenGL afterwards. edges: of several samples a pixel, those that have sums of their own (sample_edges.h).
LightBufferInCl fill_light_buffer(PassContext& work, Cached<LightBufferSums>& cache,
                                  const NormalsInCl& normals, const DepthBuffer& depth,
                                  const LightSource& lights, TargetUse use, const cl::Buffer& edges = {});

// A copy for OpenGL.
LightBuffer light_buffer_to_gl(PassContext& work, const LightBufferInCl& buffer);

}  // namespace lightgrid
