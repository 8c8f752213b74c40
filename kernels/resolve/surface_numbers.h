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
#if LANES == 16
typedef uint16 numbers_t;
static inline whole value_of_numbers(numbers_t numbers, global const uint* values, uint last) {
  int found[16];
  for (uint i = 0; i < 16; ++i) found[i] = (int)values[min(((const uint*)&numbers)[i], last)];
  return vload16(0, found);
}
#else
typedef uint numbers_t;
static inline whole value_of_numbers(numbers_t number, global const uint* values, uint last) {
  return (int)values[min(number, last)];
}
#endif
#define FIND_VALUE(kind, type, name, resource) \
  values.name = value_of_numbers(numbers, (global const uint*)arrays.name, last);
#define FIND_VALUES(inputs, effect, own) inputs(FIND_VALUE)
static inline SurfaceValues values_of_numbers(numbers_t numbers, SurfaceArrays arrays, uint last) {
  SurfaceValues values;
  SURFACE_EFFECTS(FIND_VALUES)
  return values;
}
#endif

// The last argument of kernels that write surface numbers. Only with -DSURFACE_NUMBERS.
#ifdef SURFACE_NUMBERS
#define SURFACE_NUMBERS_OUT , global surface_number_t* surface_numbers
#define SURFACE_NUMBERS_MEMBER global surface_number_t* surface_numbers;
#define GIVEN_SURFACE_NUMBERS_OUT , surface_numbers
#endif
#else
#define SURFACE_NUMBER_ARGUMENTS
#endif
#ifndef SURFACE_NUMBERS_OUT
#define SURFACE_NUMBERS_OUT
#define SURFACE_NUMBERS_MEMBER
#define GIVEN_SURFACE_NUMBERS_OUT
#endif
