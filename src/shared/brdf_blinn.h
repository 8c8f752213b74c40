// Blinn-Phong (Blinn 1977), normalised as a distribution of half vectors, with V = 1/4: (n + 2) / (8 pi)
// cos^n. The exponent n = 2 / alpha^2 - 2 gives the width of GGX's lobe (Walter et al. 2007).
#pragma once

#include "shared/power_of_cosine.h"
#include "shared/shading_point.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// The exponent.
SHARED_FUNCTION real viewer_term(Lobe l) { return 2.0f / l.alpha_squared - 2.0f; }

// D V, 1 / sr. h is the unnormalised half vector; the others are |h|^2, n.h (a cosine times |h|) and sine^2
// times |h|^2.
SHARED_FUNCTION real specular_lobe(Lobe l, real n_dot_l, real h_squared, real n_dot_h, real across_squared) {
  real lobe =
      (l.viewer + 2.0f) * (0.125f / SHADING_PI) * power_of_cosine(l.viewer, h_squared, across_squared);
  return n_dot_h * n_dot_l > REAL(0.0f) ? lobe : REAL(0.0f);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
