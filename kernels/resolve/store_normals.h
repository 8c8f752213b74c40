// Normals of LANES surfaces into the image of light_prepass (kernels/resolve/stored_normals.h).
//
// -DNORMALS_…, -DSAMPLES, -DGROUP_NUMBERS
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/resolve/stored_normals.h"
#include "kernels/resolve/texel_places.h"

// covered: lanes with a surface.
static inline void store_normals(global normal_t* to, Real3 n, mask_t covered, const TexelPlaces* places) {
  const real none = 0.0f;
  n = real3(covered ? n.x : none, covered ? n.y : none, covered ? n.z : REAL(1.0f));
#ifdef NORMAL_CHANNEL_STEPS
  const packed_normal_t packed = packed_normal(n);
#if LANES == 16
  for (uint i = 0; i < places->count; ++i) to[places->at[i]] = ((const uint*)&packed)[places->lane[i]];
#endif
#elif LANES == 16
  float16 rows[4];
  rows_of_block(rows, n, none);
#if SAMPLES == 1
  if (places->count == 16) {
    for (uint i = 0; i < 4; ++i) store_row(rows[i], (global float*)(to + places->at[4 * i]));
    return;
  }
#endif
  for (uint i = 0; i < places->count; ++i) to[places->at[i]] = ((const float4*)rows)[places->lane[i]];
#else
  const normal_t packed = (float4)(n.x, n.y, n.z, 0.0f);
#endif
#if LANES == 1
  for (uint s = 0; s < SAMPLES; ++s)
    if (places->samples >> s & 1u) to[places->pixel * SAMPLES + s] = packed;
#endif
}
