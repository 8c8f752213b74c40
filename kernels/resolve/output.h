// Outputs of the resolve kernels. A walker (kernels/resolve/{cpu,gpu}/resolve.cl and resolve_edges.cl) visits
// surfaces, LANES at a time, and an output stores what it needs of them.
//
// -DOUTPUT_RADIANCE   images of light: outputs/radiance.h
// -DOUTPUT_GBUFFER    a geometry buffer: outputs/gbuffer.h
// -DOUTPUT_NORMALS    the normals of light_prepass: outputs/normals.h
// -DOUTPUT_SUMS       images of light, under the sums of a light buffer: outputs/sums.h
// -DOUTPUT_REFLECTED  what surfaces reflect of one light: outputs/reflected.h, without pixels at edges
//
// An output defines:
// OUTPUT_LIST         what its kernels take besides the background and the image
// DECLARE_OUTPUT      stands behind the list, before what uses it
// NEEDS_EVERY_PIXEL   true if pixels without a surface are stored too
// READS_DEPTH(output) true if depths are read; not defined: as SHOWS_LIGHT(output)
// SHOWS_LIGHT(output) true if light_of() goes to output.image: RGBA per pixel, linear, row 0 at the
//                     bottom, and output.background where no surface is; not defined: never
// STORE_RESOLVED      stores what it keeps of surfaces
// LIGHT_OF            returns the light that they show, if some do
//
// With 16 lanes a walker defines, before it includes this file:
// Where            the places of 16 surfaces in images
// texel_places()   the places of their texels, one for each sample
// seen_samples()   the number of samples that see each surface; *most: the largest of these numbers
// places_of_samples() the place of each surface's k-th sample, or of its last one if it has fewer
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/texel_places.h"

#if LANES == 1
typedef struct Where {
  TexelPlaces texels;
  uint triangle;
} Where;
#define texel_places(where) (where)->texels
#endif

#define DECLARE_OUTPUT    \
  typedef struct Output { \
    float4 background;    \
    global float* image;  \
    OUTPUT_LIST(MEMBER)   \
  } Output
#define OUTPUT_ARGUMENTS float4 background, global float *image, OUTPUT_LIST(PARAMETER)
#define GIVEN_OUTPUT \
  { background, image, OUTPUT_LIST(GIVEN) }

#define STORE_RESOLVED                                                                                  \
  static inline void store_resolved(const Output* output, const Resolved* resolved, const Where* where, \
                                    const ResolveScene* scene, const ResolveLights* lights,             \
                                    constant ViewParams* view)
#define LIGHT_OF                                                                                   \
  static inline Real3 light_of(const Output* output, const Resolved* resolved, const Where* where, \
                               const ResolveLights* lights, constant float* bin_edges,             \
                               constant ViewParams* view)

#if defined(OUTPUT_GBUFFER)
#include "kernels/resolve/outputs/gbuffer.h"
#elif defined(OUTPUT_NORMALS)
#include "kernels/resolve/outputs/normals.h"
#elif defined(OUTPUT_SUMS)
#include "kernels/resolve/outputs/sums.h"
#elif defined(OUTPUT_REFLECTED)
#include "kernels/resolve/outputs/reflected.h"
#else
#include "kernels/resolve/outputs/radiance.h"
#endif

#ifndef SHOWS_LIGHT
#define SHOWS_LIGHT(output) false
LIGHT_OF { return real3(REAL(0.0f), REAL(0.0f), REAL(0.0f)); }
#endif
#ifndef READS_DEPTH
#define READS_DEPTH(output) SHOWS_LIGHT(output)
#endif
