// Images against the mean over each pixel's area in double: how near samples come to it, at edges and inside.
#pragma once

#include "accuracy/scene_occlusion.h"
#include "base/image.h"
#include "measures/results.h"
#include "oracle/pixel_area.h"
#include "run/frames.h"

namespace lightgrid::lab {

struct AreaTruth {
  std::vector<uint32_t> pixels;  // with an opaque surface or the background alone, and no doubtful shadow
  std::vector<PixelArea> areas;
};

// At a sample of the view's pixels, at most so many at edges and half as many inside, with the model of the
// view's settings. occlusion: of its scene.
AreaTruth area_truth(const ViewState& v, SceneOcclusion& occlusion, size_t max_at_edges = 1024);

// brightest: the reference's brightest channel. white: radiance that a display shows as white.
AreaError area_error(const Image& image, const AreaTruth& truth, double brightest, double white);

}  // namespace lightgrid::lab
