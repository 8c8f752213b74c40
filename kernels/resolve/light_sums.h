// A light buffer in OpenCL: the sums of LANES pixels as its images store them.
//
// -DBUFFER_BITS  8: fixed point, 16: half floats, 32: floats (default)
// -DPREPASS_FIFTH_TERM  there is a second image
#pragma once

#include "shared/light_buffer.h"

#if BUFFER_BITS == 32
typedef float light_channel_t;
#define LOAD_CHANNELS(n, at, from) vload##n(at, from)
#elif BUFFER_BITS == 16
typedef half light_channel_t;
#define LOAD_CHANNELS(n, at, from) vload_half##n(at, from)
#else
typedef uchar light_channel_t;
#define LOAD_CHANNELS(n, at, from) (convert_float##n(vload##n(at, from)) * (1.0f / 255.0f))
#endif

// A sum as its format has it; infinity becomes the largest number.
static inline real stored_light(real sum, float inverse_scale, mask_t lit) {
  const real scaled = lit ? sum * inverse_scale : REAL(0.0f);
#if BUFFER_BITS == 32
  return lane_min(scaled, REAL(LARGEST_LIGHT));
#elif BUFFER_BITS == 16
  return lane_min(scaled, REAL(65504.0f));
#else
  return lane_min(scaled, REAL(1.0f)) * 255.0f;
#endif
}
#define STORED(term) stored_light(term, inverse_scale, lit)

// The first `values` of a row of channels.
static inline void store_channels(global light_channel_t* to, const float* row, uint values) {
  for (uint i = 0; i < values; ++i) {
#if BUFFER_BITS == 32
    to[i] = row[i];
#elif BUFFER_BITS == 16
    vstore_half_rte(row[i], i, to);
#else
    to[i] = convert_uchar_sat_rte(row[i]);
#endif
  }
}

// The four sums of the first image and the two of the second, as STORED() has them, into `count` places after
// one another.
static inline void store_sums(global light_channel_t* first, global light_channel_t* second, size_t at,
                              uint count, const float* sums) {
  for (uint i = 0; i < count; ++i) {
    store_channels(first + 4 * (at + i), sums, 4);
#ifdef PREPASS_FIFTH_TERM
    store_channels(second + 2 * (at + i), sums + 4, 2);
#endif
  }
}
