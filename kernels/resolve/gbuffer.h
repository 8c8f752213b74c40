// The images of the geometry buffer in OpenCL (shared/gbuffer.h).
//
// -DCLEARCOAT    with a third image, of coats
// -DSPECULAR     with another image, of the dielectric's specular reflectance
// -DSKIN, -DMINNAERT  some surface has that model: its number is in the second image
// -DBUFFER_BITS  8, 16 or 32: bits a channel (default 32)
#pragma once

#include "shared/gbuffer.h"

#if BUFFER_BITS == 32
typedef float channel_t;
typedef float4 channel4_t;
#elif BUFFER_BITS == 16
typedef ushort channel_t;
typedef ushort4 channel4_t;
#else
typedef uchar channel_t;
typedef uchar4 channel4_t;
#endif
