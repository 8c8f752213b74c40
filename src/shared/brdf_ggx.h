// GGX (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014): the lobe of glTF 2.0.
#pragma once

#include "shared/shading_point.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Smith's term for the viewer: sqrt(n_dot_v^2 (1 - alpha^2) + alpha^2).
SHARED_FUNCTION real viewer_term(Lobe l) {
  return sqrt_real(mad_real(l.n_dot_v * l.n_dot_v, 1.0f - l.alpha_squared, l.alpha_squared));
}

// D V, 1 / sr. h is the unnormalised half vector; the others are |h|^2, n.h (a cosine times |h|) and sine^2
// times |h|^2.
SHARED_FUNCTION real specular_lobe(Lobe l, real n_dot_l, real h_squared, real n_dot_h, real across_squared) {
  // At least |h|^2 alpha^2 where n_dot_l > 0. The floor is smaller, and prevents 0/0 where h vanishes.
  real width = max_real(mad_real(n_dot_h * n_dot_h, l.alpha_squared, across_squared), REAL(1e-14f));
  // D = (alpha |h|^2 / width)^2 / pi, times V = 0.5 / (...), in one division.
  real peak = l.alpha * h_squared;
  real of_light = sqrt_real(mad_real(n_dot_l * n_dot_l, 1.0f - l.alpha_squared, l.alpha_squared));
  real smith = mad_real(n_dot_l, l.viewer, l.n_dot_v * of_light);
  return peak * peak * (0.5f / SHADING_PI) / (width * width * smith);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
