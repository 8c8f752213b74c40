// A filmic curve for displays, in C++ and GLSL. Measured pictures have Khronos PBR Neutral (shared/tone_map.h).
#pragma once

#include "shared/tone_map.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid::tone {
#endif

#define FILM_EXPOSURE 0.6f   // gives 0.18 the same 0.14 as PBR Neutral
#define FILM_BRIGHTEST 1e4f  // brighter values are white; their squares would be infinite

// From scene-referred light to [0, 1], linear: a fit to the curve of ACES, for each channel (Narkowicz, "ACES Filmic Tone
// Mapping Curve", 2016). It has a toe, which darkens shadows, and bright colours turn white early.
SHARED_FUNCTION float3 film_mapped(float3 light) {
  const float3 x = clamp(light * FILM_EXPOSURE, 0.0f, FILM_BRIGHTEST);
  return clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid::tone
#endif
