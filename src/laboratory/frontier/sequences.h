// Sequences of frames: how points flicker while the camera is still, while it moves forward, and while lights
// move (docs/details/frontier.md#sequences).
#pragma once

#include <vector>

#include "frontier/rounds.h"

namespace lightgrid::lab {

// For each pixel of `view`, which pixels of the view before show the same place of the scene, which is at
// rest, interpolated linearly; none where that is outside of the image, or something nearer or farther by 5 %
// is there. Depths as read_depth has them.
std::vector<CarriedPixel> carried_pixels(const View& view, const std::vector<float>& depth,
                                         const View& before, const std::vector<float>& depth_before);

// Draws the points' sequences from `first`, the view of their first records, frame by frame side by side, so
// that they share the truth's frames and lights move once; and puts the figures into those records, which it
// writes anew. Records that have them are left out, and refused points. Not against a truth of areas, whose
// frames take too long. The scene is left as it was.
void measure_sequences(Renderer& renderer, GpuScene& gpu, Scene& scene, const SceneChoice& choice,
                       const View& first, const FrontierJob& job, std::vector<MeasuredPoint>& points,
                       RecordFile& file);

}  // namespace lightgrid::lab
