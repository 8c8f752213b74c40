// Input and output of the walker over stored surfaces (kernels/resolve/{cpu,gpu}/shade_stored.cl).
//
// -DSTORED_SURFACES  a geometry buffer, and an image of light: stored/surfaces.h
// -DSTORED_NORMALS   normals, and a light buffer: stored/normals.h
//
// Each defines:
// STORED_LIST       its images, and other arguments of its own
// DECLARE_STORED    stands behind the list, before what uses it
// NEEDS_EVERY_PIXEL  true if pixels without a light are stored too
// shade()            shades a batch of surfaces
#pragma once

#include "kernels/common/lists.h"
#include "kernels/resolve/surface_numbers.h"

#define DECLARE_STORED    \
  typedef struct Stored { \
    STORED_LIST(MEMBER)   \
  } Stored
#if defined(STORED_SURFACES)
#include "kernels/resolve/stored/surfaces.h"
#elif defined(STORED_NORMALS)
#include "kernels/resolve/stored/normals.h"
#endif

#if !defined(NUMBER_BITS) || !defined(HAS_SURFACE_VALUES)
#define VALUES_OF_BATCH(b) WHOLE(0)
#else
static inline whole surface_numbers_of(global const surface_number_t* image, const StoredBatch* b) {
  whole numbers;
  SET_LANES(int, numbers, image[IMAGE_OF(b, i)])
  return numbers;
}
#define VALUES_OF_BATCH(b) \
  values_of_numbers(surface_numbers_of(surface_numbers, b), (SurfaceArrays)GIVEN_SURFACE_ARRAYS, last_number)
#endif
