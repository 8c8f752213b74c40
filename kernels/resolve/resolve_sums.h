// Radiance of resolved surfaces under the sums of a light buffer: what they show of themselves and
// directional lights, as kernels/resolve/resolve_light.h computes it, and the light of the sums
// (shared/light_buffer.h).
#pragma once

#include "kernels/resolve/light_sums.h"
#include "kernels/resolve/resolve_light.h"

// x, y: pixel centres. covered: lanes with a surface.
static inline Real3 radiance_of_sums(const Attributes* a, const Surface* s, real x, real y, real depth,
                                     mask_t covered, LightTerms sums, LightBufferParams of,
                                     const ResolveLights* l, constant ViewParams* view) {
  const ShadingPoint p = resolved_point(a, s, x, y, depth, covered, view);
  const Real3 sum = add3(own_light(&p, s, covered, l, view), light_of_terms(p, sums, of));
  return real3(s->unlit ? s->base_color.x : sum.x, s->unlit ? s->base_color.y : sum.y,
               s->unlit ? s->base_color.z : sum.z);
}
