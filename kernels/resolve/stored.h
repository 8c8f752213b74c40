// Input and output of the walker over stored surfaces (kernels/resolve/{cpu,gpu}/shade_stored.cl).
//
// -DSTORED_SURFACES  a geometry buffer, and an image of light: stored/surfaces.h
// -DSTORED_NORMALS   normals, and a light buffer: stored/normals.h
//
// Each defines:
// STORED_ARGUMENTS, Stored, GIVEN_STORED  its images
// NEEDS_EVERY_PIXEL  true if pixels without a light are stored too
// shade()            shades a batch of surfaces
#pragma once

#include "kernels/resolve/group_numbers.h"
#if defined(STORED_SURFACES)
#include "kernels/resolve/stored/surfaces.h"
#elif defined(STORED_NORMALS)
#include "kernels/resolve/stored/normals.h"
#endif

#if !defined(GROUPS)
#define GROUPS_OF_BATCH(b) WHOLE(0)
#elif LANES == 16
static inline uint16 group_numbers_of(global const group_number_t* image, const StoredBatch* b) {
  uint numbers[16];
  for (uint i = 0; i < 16; ++i) numbers[i] = image[IMAGE_OF(b, i)];
  return vload16(0, numbers);
}
#define GROUPS_OF_BATCH(b) groups_of_numbers(group_numbers_of(group_numbers, b), GROUP_MASKS, last_group)
#else
#define GROUPS_OF_BATCH(b) groups_of_numbers(group_numbers[(b)->image], GROUP_MASKS, last_group)
#endif
