// Where the renderer's buffers meet the double-precision oracle (reference/).
#pragma once

#include "passes/read_outs/depth.h"
#include "passes/read_outs/surfaces.h"
#include "reference/lit_set.h"
#include "reference/shading.h"
#include "results/results.h"
#include "compare/run_technique.h"

namespace lightgrid {

// The surface at a pixel, for the oracle to shade.
Surface surface_of(const SurfaceImages& surfaces, uint32_t pixel);

// The cell of the light grid that shading reads at each pixel, from the depth image of the frame.
std::vector<uint32_t> cells_of_pixels(const RenderView& v, const std::vector<float>& depth);

// And its z-bin: 0 where there are none.
std::vector<uint32_t> z_bins_of_pixels(const RenderView& v, const std::vector<float>& depth);

// What the last frame of a run shaded opaque surfaces with: as the technique tells it, from the light grid, or every
// point and spot light at every pixel. A pixel's slice and z-bin follow from its depth; lights that its
// z-bin passes over are not listed for it.
ListedLights listed_lights(TechniqueRun& run, const std::vector<float>& depth);

// Those against the lights that truly reach each pixel.
LitPairs count_listed_pairs(TechniqueRun& run, const std::vector<float>& depth);

class SurfaceOracle;

// Model and precision errors at `pixels`, which the oracle can shade. `every_light` is the float image of the technique
// `forward`, of which only these pixels are read.
ReferenceErrors measure_reference_errors(const SurfaceOracle& oracle, const Image& every_light,
                                         const std::vector<uint32_t>& pixels);

// Model and precision errors at up to `samples` pixels that no blended surface covers: shades the surfaces that
// OpenGL saw, in double. `every_light` is the float image of the technique `forward`.
ReferenceErrors measure_reference_errors(RenderView& v, const Image& every_light, const std::vector<float>& depth,
                                         size_t samples);

}  // namespace lightgrid
