// What deferred_tiled and forward_plus_compute share: they differ in how the geometry buffer is filled.
#pragma once

#include "passes/gbuffer.h"
#include "techniques/technique.h"

namespace lightgrid {

// Without point and spot lights there is no light pass, and the image takes all.
inline OwnLight own_light_of(const Frame& f) {
  return f.plan.light_grid && !f.plan.own_light ? OwnLight::in_light_pass : OwnLight::in_image;
}

// Culls lights, adds those of each tile's list to the geometry buffer's image, and lays blended surfaces over it.
ShadedImage add_tiled_light(Frame& f, const GBuffer& gbuffer, const DepthBounds& bounds);

}  // namespace lightgrid
