// Shadows of pixels at edges: the rays start at each of their surfaces.
#pragma once

#ifdef SHADOWS_TRACED
#include "kernels/shadows/traced_shadows.h"
#define LIGHT_EDGES                      \
  TracedShadows traced = TRACED_SHADOWS; \
  lights.lights.shadows.traced = &traced;
#else
#define TRACED_ARGUMENTS
#define LIGHT_EDGES light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
#endif
