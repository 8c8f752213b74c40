// The light groups of pixels whose instance is not known: an image of the numbers of masks
// (src/engine/passes/common/group_numbers.h), and the masks behind the lights' groups (shared/light_table.h).
//
// -DGROUPS       there are groups
// -DGROUP_BITS   8 or 16: bits of a number
#pragma once

#include "shared/real.h"

#ifdef GROUPS
#ifndef GROUP_BITS
#define GROUP_BITS 8
#endif
#if GROUP_BITS == 16
typedef ushort group_number_t;
#else
typedef uchar group_number_t;
#endif

// Before LIGHT_ARGUMENTS: the image, and the last number. Past the image's end it may have any.
#define GROUP_NUMBER_ARGUMENTS global const group_number_t *group_numbers, uint last_group,
#define GROUP_MASKS (light_group_masks + view->light_count + view->directional_count)

#if LANES == 16
static inline whole groups_of_numbers(uint16 numbers, global const uint* masks, uint last) {
  int found[16];
  for (uint i = 0; i < 16; ++i) found[i] = (int)masks[min(((const uint*)&numbers)[i], last)];
  return vload16(0, found);
}
#else
static inline whole groups_of_numbers(uint number, global const uint* masks, uint last) {
  return (int)masks[min(number, last)];
}
#endif

// The last argument of kernels that write group numbers. Only with -DGROUP_NUMBERS.
#ifdef GROUP_NUMBERS
#define GROUP_NUMBERS_OUT , global group_number_t* group_numbers
#define GROUP_NUMBERS_MEMBER global group_number_t* group_numbers;
#define GIVEN_GROUP_NUMBERS_OUT , group_numbers
#endif
#else
#define GROUP_NUMBER_ARGUMENTS
#endif
#ifndef GROUP_NUMBERS_OUT
#define GROUP_NUMBERS_OUT
#define GROUP_NUMBERS_MEMBER
#define GIVEN_GROUP_NUMBERS_OUT
#endif
