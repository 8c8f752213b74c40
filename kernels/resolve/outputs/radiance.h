// Radiance under the lists of lights, or other sources of lights, of kernels/resolve/resolve_light.h.
//
// background  of pixels without a surface
// image       out: RGBA per pixel
#pragma once

#include "kernels/resolve/resolve_light.h"

#define OUTPUT_ARGUMENTS float4 background, global float *image
typedef struct Output {
  float4 background;
  global float* image;
} Output;
#define GIVEN_OUTPUT \
  { background, image }
#define READS_DEPTH(output) true
#define SHOWS_LIGHT(output) true
#define NEEDS_EVERY_PIXEL false

STORE_RESOLVED {}
LIGHT_OF { return radiance(resolved, lights, bin_edges, view); }
