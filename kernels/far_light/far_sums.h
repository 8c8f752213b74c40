// Far light at LANES samples of its volume (shared/far_light.h): the sum over all lights in their order,
// whatever the device.
//
// -DSPOTS, -DVIRTUAL_LIGHTS, -DWINDOW_SMOOTH, -DWINDOW_NONE  shared/light_table.h, shared/punctual_light.h
#pragma once

#include "kernels/common/light_columns.h"
#include "shared/far_light.h"

static inline FarLight far_light_of(const LightColumns* lights, uint count, Real3 position) {
  FarLight sum = {{0}};
  for (uint i = 0; i < count; ++i) {
    const PunctualLight light = light_at(lights, i);
    const Arrival arrival = arrival_beyond(position, light);
    const Real3 l = arrival.to_light;
    const FarMoments v = {l.x, l.y, l.z, l.x * l.x, l.y * l.y, l.z * l.z, l.x * l.y, l.x * l.z, l.y * l.z};
    sum.red = add_moments(sum.red, arrival.attenuation * light.color.x, v);
    sum.green = add_moments(sum.green, arrival.attenuation * light.color.y, v);
    sum.blue = add_moments(sum.blue, arrival.attenuation * light.color.z, v);
  }
  return sum;
}

#if LANES == 16
#define FAR_LANE(v, i) (((const float*)&(v))[i])
#else
#define FAR_LANE(v, i) (v)
#endif

// Of lane i, into the planes of sample `at` of `samples`.
static inline void store_far_light(const FarLight* f, uint i, global float4* moments, size_t at,
                                   size_t samples) {
  const FarMoments* const colors[3] = {&f->red, &f->green, &f->blue};
  for (uint c = 0; c < 3; ++c) {
    const FarMoments* m = colors[c];
    moments[2 * c * samples + at] =
        (float4)(FAR_LANE(m->x, i), FAR_LANE(m->y, i), FAR_LANE(m->z, i), FAR_LANE(m->xx, i));
    moments[(2 * c + 1) * samples + at] =
        (float4)(FAR_LANE(m->yy, i), FAR_LANE(m->zz, i), FAR_LANE(m->xy, i), FAR_LANE(m->xz, i));
  }
  moments[6 * samples + at] =
      (float4)(FAR_LANE(f->red.yz, i), FAR_LANE(f->green.yz, i), FAR_LANE(f->blue.yz, i), 0.0f);
}
