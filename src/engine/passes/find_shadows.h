// The shadows of a frame, after its depth is known and before it is shaded: which lights are hidden from
// which pixels, by rays (rays/ray_scene.h). Every technique's loop reads them (shared/shadow_bits.h).
#pragma once

#include "passes/common/frame.h"
#include "passes/rasterize.h"

namespace lightgrid {

// For light loops of this frame, of opaque and of blended surfaces. `visible`: of OpenCL's rasteriser; null:
// OpenGL drew the depth image, and draws its triangles' numbers here. depth: of the same surfaces, read only
// where the plan's `shadows` is set. blended: of OpenCL's rasteriser; null: OpenGL draws them here, or none
// is in view. Throws Error(machine) if the device has no doubles, Error(input) if a tile's bits alone take
// more memory than there may be.
void find_shadows(PassContext& work, PassCaches& caches, const VisibilityBuffer* visible,
                  const DepthBuffer& depth, const BlendedTriangles* blended);

// With the setting shadow-reuse: whether the bits of the view's last frame are those of this one, since
// neither camera, lights, surfaces nor the lights that need shadows changed. find_shadows then finds nothing.
bool shadows_are_unchanged(PassContext& work, Cached<ShadowBits>& cache);

}  // namespace lightgrid
