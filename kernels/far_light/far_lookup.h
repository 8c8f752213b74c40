// Far light at LANES points: what kernels/far_light/*/fill_far_light.cl wrote, interpolated between the eight
// samples around each of them.
#pragma once

#include "shared/far_light.h"

static inline FarMoments stored_moments(float4 a, float4 b, float yz) {
  const FarMoments m = {REAL(a.x), REAL(a.y), REAL(a.z), REAL(a.w), REAL(b.x),
                        REAL(b.y), REAL(b.z), REAL(b.w), REAL(yz)};
  return m;
}

// Adds the eight samples of the cell whose first is `at`; x, y and z from 0 to 1 in it. weight: 1 of the
// lanes in that cell, 0 of others.
static inline FarLight add_far_cell(FarLight sum, real weight, real x, real y, real z,
                                    global const float4* at, size_t row, size_t slice, size_t samples) {
  for (uint corner = 0; corner < 8; ++corner) {
    const bool right = (corner & 1) != 0, up = (corner & 2) != 0, behind = (corner & 4) != 0;
    const real share = weight * (right ? x : 1.0f - x) * ((up ? y : 1.0f - y) * (behind ? z : 1.0f - z));
    global const float4* m = at + (right ? 1 : 0) + (up ? row : 0) + (behind ? slice : 0);
    const float4 last = m[6 * samples];
    sum.red = add_moments(sum.red, share, stored_moments(m[0], m[samples], last.x));
    sum.green = add_moments(sum.green, share, stored_moments(m[2 * samples], m[3 * samples], last.y));
    sum.blue = add_moments(sum.blue, share, stored_moments(m[4 * samples], m[5 * samples], last.z));
  }
  return sum;
}

// In lanes that are not `lit`: zeros.
static inline FarLight far_light_at(Real3 position, mask_t lit, global const float4* moments,
                                    constant FarLookup* far) {
  const Real3 place = far_place(position, far);
  const size_t row = (size_t)far->last_x + 1, slice = row * ((size_t)far->last_y + 1),
               samples = slice * ((size_t)far->last_z + 1);
  // The last sample is the far end of the last cell.
  const real x0 = lane_min(floor(place.x), REAL(far->last_x - 1.0f)),
             y0 = lane_min(floor(place.y), REAL(far->last_y - 1.0f)),
             z0 = lane_min(floor(place.z), REAL(far->last_z - 1.0f));
  const real x = place.x - x0, y = place.y - y0, z = place.z - z0;
  FarLight sum = {{0}};
#if LANES == 16
  // The pixels' cells one after the other: neighbours are mostly in one.
  const whole cell = TO_WHOLE(x0) + TO_WHOLE(y0) * (whole)((int)row) + TO_WHOLE(z0) * (whole)((int)slice);
  for (uint left = mask_bits(lit); left != 0;) {
    const int one = ((const int*)&cell)[lowest_bit(left)];
    const mask_t here = lit & (cell == (whole)(one));
    left &= ~mask_bits(here);
    sum = add_far_cell(sum, here ? REAL(1.0f) : REAL(0.0f), x, y, z, moments + one, row, slice, samples);
  }
#else
  if (lit) {
    const size_t cell = (size_t)x0 + (size_t)y0 * row + (size_t)z0 * slice;
    sum = add_far_cell(sum, 1.0f, x, y, z, moments + cell, row, slice, samples);
  }
#endif
  return sum;
}
