// The surfaces of pixels whose instance is not known: an image of their numbers
// (src/engine/passes/common/surface_numbers.h), by which their values are found (shared/surface_values.h).
//
// -DNUMBER_BITS  8 or 16: bits of a number. Without, there is no image
#pragma once

#include "shared/real.h"
#include "shared/surface_values.h"

#ifdef NUMBER_BITS
#if NUMBER_BITS == 16
typedef ushort surface_number_t;
#else
typedef uchar surface_number_t;
#endif

// Before LIGHT_ARGUMENTS: the image, and the last number. Past the image's end it may have any.
#define SURFACE_NUMBER_ARGUMENTS global const surface_number_t *surface_numbers, uint last_number,

#ifdef HAS_SURFACE_VALUES
#define FIND_VALUE(kind, type, name, resource) \
  SET_LANES(int, values.name, ((global const uint*)arrays.name)[min((uint)INDEX_LANE(numbers, i), last)])
#define FIND_VALUES(inputs, effect, own) inputs(FIND_VALUE)
static inline SurfaceValues values_of_numbers(whole numbers, SurfaceArrays arrays, uint last) {
  SurfaceValues values;
  SURFACE_EFFECTS(FIND_VALUES)
  return values;
}
#endif

// An argument of kernels that write surface numbers, in the form of lists. Only with -DSURFACE_NUMBERS.
#ifdef SURFACE_NUMBERS
#define SURFACE_NUMBERS_OUT(X) X(global surface_number_t*, surface_numbers)
#endif
#else
#define SURFACE_NUMBER_ARGUMENTS
#endif
#ifndef SURFACE_NUMBERS_OUT
#define SURFACE_NUMBERS_OUT(X)
#endif
