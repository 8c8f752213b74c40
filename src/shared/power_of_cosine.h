// A power of the cosine between a unit normal and a half vector, as Blinn-Phong's lobe has it.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// h_squared: |h|^2 of the unnormalised half vector; across_squared: |normal x h|^2.
SHARED_FUNCTION real power_of_cosine(real exponent, real h_squared, real across_squared) {
  // log cos^2 = log(1 - sin^2). The rounding of 1 - sin^2 would grow to n / 2 roundings (exponents reach half
  // a million), so the lost part is added again (Kahan's log1p).
  real sine2 = min_real(across_squared / h_squared, REAL(1.0f));
  EXACTLY real cosine2 = max_real(1.0f - sine2, REAL(1e-30f));
  EXACTLY real rounded = 1.0f - cosine2;
  real log_cosine2 = log_real(cosine2) * (sine2 / max_real(rounded, REAL(1e-30f)));
  log_cosine2 = rounded > REAL(0.0f) ? log_cosine2 : -sine2;
  return exp_real(0.5f * exponent * log_cosine2);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
