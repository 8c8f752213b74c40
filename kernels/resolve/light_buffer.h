// The sums of a light buffer (shared/light_buffer.h) at LANES pixels of one cell, from the lights of its
// list.
//
// -DNORMALS_OCTAHEDRAL, -DNORMALS_SPHEREMAP, -DNORMALS_XYZ8  the format of normals (shared/stored_normal.h);
// without, floats -DBUFFER_BITS, -DPREPASS_FIFTH_TERM  as kernels/resolve/light_sums.h says -DINDEX_32,
// -DZ_BINS, -DSPOTS, -DLAMBERT  as kernels/resolve/shade_pixels.h says
#pragma once

#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/light_sums.h"
#include "kernels/resolve/shade_pixels.h"
#include "kernels/resolve/stored_normals.h"

// A light that reaches none of the pixels, or that none of them faces, would add exact zeros.
static inline LightTerms with_terms(LightTerms sum, Real3 position, Real3 normal, Real3 to_viewer,
                                    whole groups, mask_t lit, uint index, const Lights* lights,
                                    float exponent) {
  const PunctualLight light = light_at(lights, index);
#ifdef GROUPS
  if (!any_lane(lit & groups_meet(light.groups, groups))) return sum;
#endif
  if (!any_lane(lit & in_range(position, light))) return sum;
  Arrival arrival = arrival_at(position, light);
  const mask_t reached = (arrival.attenuation > REAL(0.0f)) & (dot3(normal, arrival.to_light) > REAL(0.0f));
  if (!any_lane(lit & reached)) return sum;
  arrival.attenuation = arrival.attenuation * light_reaches(light, position, groups);
#ifdef SHADOWS
  if (!any_lane(lit & reached & (arrival.attenuation > REAL(0.0f)))) return sum;
#endif
  return add_terms(sum, light_terms(normal, to_viewer, arrival, light, REAL(exponent)));
}

// In the order of the list. groups: of the surfaces; without -DGROUPS they are not read.
static inline LightTerms terms_of_list(Real3 position, Real3 normal, whole groups, mask_t lit,
                                       global const index_t* list,
                                       uint count, PixelBins bins, const Lights* lights, float exponent) {
  const Real3 to_viewer = direction_to_viewer(position);
  LightTerms sum = no_terms();
  for (uint i = 0; i < count; ++i) {
    const uint index = list[i];
#ifdef Z_BINS
    if (!bins_meet(lights->bins[index], bins.first, bins.last)) continue;
#endif
    sum = with_terms(sum, position, normal, to_viewer, groups, lit, index, lights, exponent);
  }
  return sum;
}
