// Compares the renderer's buffers with the oracle (oracle/).
#pragma once

#include "measures/results.h"
#include "oracle/lit_set.h"
#include "oracle/shading.h"
#include "run/frames.h"

namespace lightgrid::lab {

class ShadowTruth;

// The surface at a pixel, for the oracle to shade.
Surface surface_of(const SurfaceImages& surfaces, uint32_t pixel);

// The point and spot lights in view space, in the order of lists.
std::vector<ViewLight> local_lights(const ViewState& v);

// The lights that the last frame of a run used on opaque surfaces (Frame::listed), or every point and spot
// light at every pixel.
ListedLights listed_lights(TechniqueRun& run, const std::vector<float>& depth);

// The masks of the surface at each pixel, by the triangle shown there; empty where the plan has none.
std::vector<uint32_t> masks_of_pixels(const FramePlan& plan, const Scene& scene,
                                      const std::vector<SceneTriangle>& shown);

// Compares those with the lights that reach each pixel, and the frame's shadows with `seen` (null: none).
LitPairs count_listed_pairs(TechniqueRun& run, const std::vector<float>& depth,
                            const SeenPairs* seen = nullptr);

// The sum over the layers of its blended surfaces, with every light: what their lists lack is not counted.
// None if no light casts or nothing blended is in view.
std::optional<LitPairs> count_blended_pairs(TechniqueRun& run, ShadowTruth& truth);

// The same as figures of a row. seen: as above.
PairCounts pair_counts(const TechniqueRun& run, const LitPairs& pairs, const SeenPairs* seen);

class SurfaceOracle;

// Model and precision errors at `pixels`, which the oracle can shade. `every_light` is the float image of the
// technique `forward`; only these pixels are read.
ReferenceErrors measure_reference_errors(const SurfaceOracle& oracle, const Image& every_light,
                                         const std::vector<uint32_t>& pixels);

// Model and precision errors at up to `samples` pixels without blended surfaces: shades the surfaces that
// OpenGL read, in double. `every_light` is the float image of the technique `forward`.
ReferenceErrors measure_reference_errors(RenderView& v, const Image& every_light,
                                         const std::vector<float>& depth, size_t samples);

}  // namespace lightgrid::lab
