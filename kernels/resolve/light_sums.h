// A light buffer in OpenCL: the sums of LANES pixels as its images store them.
//
// -DBUFFER_BITS  8: fixed point, 16: half floats, 32: floats (default)
// -DPREPASS_FIFTH_TERM  there is a second image
// -DLIGHT_LUV  colours are stored as hue and luminance (shared/light_luv.h)
#pragma once

#include "shared/light_buffer.h"
#include "shared/light_luv.h"

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

// A colour's three channels.
static inline Real3 stored_color(Real3 sum, float inverse_scale, mask_t lit) {
#ifdef LIGHT_LUV
  const Real3 luv = luv_of_light(real3(finite_light(sum.x), finite_light(sum.y), finite_light(sum.z)));
  return real3(stored_light(luv.x, 1.0f, lit), stored_light(luv.y, 1.0f, lit), STORED(luv.z));
#else
  return real3(STORED(sum.x), STORED(sum.y), STORED(sum.z));
#endif
}

// The same read again, with the buffer's scale.
static inline Real3 read_color(Real3 stored, float scale) {
#ifdef LIGHT_LUV
  return light_of_luv(real3(stored.x, stored.y, stored.z * scale));
#else
  return scale3(stored, REAL(scale));
#endif
}

// n values, as STORED() has them.
#if BUFFER_BITS == 32
#define STORE_CHANNELS(n, values, to) vstore##n(values, 0, to)
#elif BUFFER_BITS == 16
#define STORE_CHANNELS(n, values, to) vstore_half##n##_rte(values, 0, to)
#else
#define STORE_CHANNELS(n, values, to) vstore##n(convert_uchar##n##_sat_rte(values), 0, to)
#endif
