// Area lights (docs/area_lights.md): rectangles that emit from one side. Sums over n x n points of a
// rectangle. The points crowd where the summed function is large, and no point is below the surface's horizon.
#pragma once

#include "shared/brdf.h"
#include "shared/inputs.h"

// AREA_RULE values of Gauss's rule on 0 to 1: a position and a weight, of the first with n, their number. Then
// three per light: half of the width with 1 (0: a light without an area), half of the height, and the direction
// in which it emits; view space, metres.
#define AREA_RULE 4
#define AREA_LIGHTS_LIT_INPUTS(ROW) ROW(ColumnInput, Float4, area_sides, samplerBuffer)

#ifdef EFFECT_AREA_LIGHTS
#ifdef LIGHTGRID_GLSL
AREA_LIGHTS_LIT_INPUTS(INPUT_UNIFORM)
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// A rectangle from a point: centre + x across + y up with x and y from -1 to 1. ahead: the distance of the
// point from its plane, above 0 on the side that is lit.
SHARED_STRUCT(SeenArea) {
  Real3 centre, across, up;
  real ahead;
};

// The function 1 / (q + least)^2 on the rectangle, with q = a dx^2 + 2 b dx dy + c dy^2 about x and y. The
// light's own falloff has this form, and GGX's lobe if its slope is linear in x and y. det = a c - b^2.
SHARED_STRUCT(AreaPeak) { real x, y, a, b, c, det, least; };

// An axis: position = middle + width s / sqrt(1 - s^2) for s from low to high.
SHARED_STRUCT(AreaAxis) { real middle, width, low, high; };

SHARED_FUNCTION Real3 mad3(Real3 v, real factor, Real3 more) {
  return real3(mad_real(v.x, factor, more.x), mad_real(v.y, factor, more.y), mad_real(v.z, factor, more.z));
}

SHARED_FUNCTION real sine_of_tangent(real t) { return t * inverse_sqrt_real(mad_real(t, t, REAL(1.0f))); }

// A width below the distance of the peak from the range would crowd the points at the range's end.
SHARED_FUNCTION AreaAxis area_axis(real middle, real width, real low, real high) {
  AreaAxis axis;
  axis.middle = min_real(max_real(middle, REAL(-4.0f)), REAL(4.0f));
  real apart = max_real(max_real(low - axis.middle, axis.middle - high), REAL(0.0f));
  axis.width = min_real(max_real(max_real(width, apart), REAL(1e-7f)), REAL(1e4f));
  axis.low = sine_of_tangent((low - axis.middle) / axis.width);
  axis.high = sine_of_tangent((high - axis.middle) / axis.width);
  return axis;
}

SHARED_FUNCTION real root_of_sine(real s) {
  return sqrt_real(max_real(mad_real(-s, s, REAL(1.0f)), REAL(1e-7f)));
}

// The integral of sqrt(1 - s^2) from 0. asin(s) = 2 atan(s / (1 + sqrt(1 - s^2))), with atan's polynomial on
// -1 to 1: largest relative error 1.7e-7.
SHARED_FUNCTION real half_disk(real s) {
  real root = root_of_sine(s), t = s / (1.0f + root), t2 = t * t;
  real sum = mad_real(REAL(0.00276628346f), t2, REAL(-0.015731249f));
  sum = mad_real(sum, t2, REAL(0.0421376228f));
  sum = mad_real(sum, t2, REAL(-0.0745685473f));
  sum = mad_real(sum, t2, REAL(0.106183708f));
  sum = mad_real(sum, t2, REAL(-0.141977981f));
  sum = mad_real(sum, t2, REAL(0.199918717f));
  sum = mad_real(sum, t2, REAL(-0.333330363f));
  return mad_real(0.5f * s, root, t * mad_real(sum, t2, REAL(1.0f)));
}

// The functions that are summed.
#define AREA_DIFFUSE 0  // the diffuse part of the BRDF
#define AREA_LOBE 1     // a lobe times 1 - g, times g, and itself; g: Schlick's term
#define AREA_COSINE 2   // the cosine times 1 - g, and itself
#define AREA_POWER 3    // a power of the half vector's cosine, and that times g

// One direction's part, with the cosine at the surface.
SHARED_FUNCTION Real3 area_part(int part, ShadingPoint p, Real3 normal, Real3 to_viewer, Lobe lobe,
                                Real3 to_light) {
  real n_dot_l = min_real(max_real(dot3(normal, to_light), REAL(0.0f)), REAL(1.0f));
#ifdef LAMBERT
  real grazing5 = REAL(0.0f);
#else
  Real3 h = add3(to_light, to_viewer);
  real h_squared = max_real(dot3(h, h), REAL(1e-8f));
  real grazing = max_real(mad_real(-0.5f, sqrt_real(h_squared), 1.0f), REAL(0.0f));
  real grazing2 = grazing * grazing;
  real grazing5 = grazing2 * grazing2 * grazing;
  if (part == AREA_LOBE) {
    real value = n_dot_l * lobe_about(normal, lobe, n_dot_l, h, h_squared);
    return real3(value * (1.0f - grazing5), value * grazing5, value);
  }
  if (part == AREA_POWER) {
    Real3 across = cross3(normal, h);
    real power = power_of_cosine(lobe.viewer, h_squared, dot3(across, across));
    real value = dot3(normal, h) * n_dot_l > REAL(0.0f) ? n_dot_l * power : REAL(0.0f);
    return real3(value, value * grazing5, REAL(0.0f));
  }
#endif
  real facing = n_dot_l * (1.0f - grazing5);
  if (part == AREA_COSINE) return real3(facing, n_dot_l, REAL(0.0f));
#ifdef SPECULAR
  facing = mad_real(facing, p.diffuse_facing, n_dot_l * p.diffuse_always);
#endif
  Real3 diffuse = DIFFUSE_AT(p, n_dot_l);
  diffuse = scale3(diffuse, facing);
#ifdef SKIN
  diffuse = add3(diffuse, subsurface_of(p, to_light));
#endif
  return diffuse;
}

// The part of -1 to 1 in which first + slope x is at least 0.
SHARED_FUNCTION AreaAxis above_horizon(real first, real slope) {
  AreaAxis range;
  real end = -first / (slope == 0.0f ? REAL(1.0f) : slope);
  range.low = slope > 0.0f ? min_real(max_real(end, REAL(-1.0f)), REAL(1.0f)) : REAL(-1.0f);
  range.high = slope < 0.0f ? max_real(min_real(end, REAL(1.0f)), REAL(-1.0f)) : REAL(1.0f);
  return range;
}

// The mean over the rectangle of a part times cosine / distance^2 at the light.
SHARED_FUNCTION Real3 area_sum(int part, ShadingPoint p, Real3 normal, Real3 to_viewer, Lobe lobe,
                               SeenArea seen, AreaPeak peak AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  real level = dot3(normal, seen.centre), sideways = dot3(normal, seen.across),
       upwards = dot3(normal, seen.up);
#ifdef SKIN
  if (part == AREA_DIFFUSE) {  // light from below the horizon counts
    level = REAL(1.0f);
    sideways = upwards = REAL(0.0f);
  }
#endif
  AreaAxis range = above_horizon(level + max_real(upwards, -upwards), sideways);
  real slope = peak.det / peak.c;
  AreaAxis outer = area_axis(peak.x, sqrt_real(peak.least / slope), range.low, range.high);
  Real3 sum = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
  float count = COLUMN(Float4, area_sides, 0).z;
  for (int i = 0; i < count; ++i) {
    real s = mad_real(outer.high - outer.low, REAL(COLUMN(Float4, area_sides, i).x), outer.low);
    real root = root_of_sine(s), x = mad_real(outer.width, s / root, outer.middle), aside = x - peak.x;
    range = above_horizon(mad_real(sideways, x, level), upwards);
    AreaAxis inner =
        area_axis(mad_real(-peak.b / peak.c, aside, peak.y),
                  sqrt_real(mad_real(slope * aside, aside, peak.least) / peak.c), range.low, range.high);
    Real3 row = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f)), column = mad3(seen.across, x, seen.centre);
    real length = inner.high - inner.low, rule = REAL(0.0f);
    for (int j = 0; j < count; ++j) {
      real t = mad_real(length, REAL(COLUMN(Float4, area_sides, j).x), inner.low);
      real weight = REAL(COLUMN(Float4, area_sides, j).y), other = root_of_sine(t);
      Real3 offset = mad3(seen.up, mad_real(inner.width, t / other, inner.middle), column);
      real inverse = inverse_sqrt_real(max_real(dot3(offset, offset), REAL(1e-14f)));
      Real3 value = area_part(part, p, normal, to_viewer, lobe, scale3(offset, inverse));
      real per_other = inverse / other;
      row = mad3(value, weight * (per_other * per_other * per_other), row);
      rule = mad_real(weight, other, rule);
    }
    // The rule's error for the pure peak divides out.
    real exact = (half_disk(inner.high) - half_disk(inner.low)) / max_real(length, REAL(1e-4f));
    real share = length > REAL(0.1f) ? exact / rule : REAL(1.0f);
    real weight = REAL(COLUMN(Float4, area_sides, i).y) * (outer.high - outer.low) * outer.width;
    sum = mad3(row, weight / (root * root * root) * (inner.width * length) * share, sum);
  }
  return scale3(sum, 0.25f * seen.ahead);
}

// The peak of the light's own falloff: the foot of the point on the light's plane.
SHARED_FUNCTION AreaPeak falloff_peak(SeenArea seen) {
  AreaPeak peak;
  peak.a = dot3(seen.across, seen.across);
  peak.b = REAL(0.0f);
  peak.c = dot3(seen.up, seen.up);
  peak.det = peak.a * peak.c;
  peak.x = -dot3(seen.centre, seen.across) / peak.a;
  peak.y = -dot3(seen.centre, seen.up) / peak.c;
  peak.least = seen.ahead * seen.ahead;
  return peak;
}

#ifndef LAMBERT
// The peak of a lobe. The slope h / (n.h) - n of the half vector is linearised where the mirrored viewer sees
// the rectangle, or nearest to it.
SHARED_FUNCTION AreaPeak lobe_peak(SeenArea seen, Real3 normal, Real3 to_viewer, Real3 emits,
                                   real alpha_squared) {
  real twice = 2.0f * dot3(normal, to_viewer);
  Real3 mirrored = mad3(normal, twice, scale3(to_viewer, REAL(-1.0f)));
  real reach = seen.ahead / max_real(-dot3(mirrored, emits), REAL(1e-4f));
  Real3 hit = mad3(mirrored, reach, scale3(seen.centre, REAL(-1.0f)));
  real x =
      min_real(max_real(dot3(hit, seen.across) / dot3(seen.across, seen.across), REAL(-1.0f)), REAL(1.0f));
  real y = min_real(max_real(dot3(hit, seen.up) / dot3(seen.up, seen.up), REAL(-1.0f)), REAL(1.0f));
  Real3 to = mad3(seen.up, y, mad3(seen.across, x, seen.centre));
  real inverse = inverse_sqrt_real(max_real(dot3(to, to), REAL(1e-14f)));
  to = scale3(to, inverse);
  Real3 h = add3(to, to_viewer);
  real per_height = 1.0f / max_real(dot3(normal, h), REAL(0.02f));
  Real3 slope = scale3(h, per_height);
  // Derivatives of h, then of the slope.
  Real3 h_x = scale3(mad3(to, -dot3(to, seen.across), seen.across), inverse);
  Real3 h_y = scale3(mad3(to, -dot3(to, seen.up), seen.up), inverse);
  Real3 s_x = scale3(mad3(slope, -dot3(normal, h_x), h_x), per_height);
  Real3 s_y = scale3(mad3(slope, -dot3(normal, h_y), h_y), per_height);
  Real3 at = mad3(normal, REAL(-1.0f), slope), apart = cross3(s_x, s_y);
  AreaPeak peak;
  peak.a = max_real(dot3(s_x, s_x), REAL(1e-20f));
  peak.b = dot3(s_x, s_y);
  peak.c = max_real(dot3(s_y, s_y), REAL(1e-20f));
  peak.det = max_real(dot3(apart, apart), REAL(1e-6f) * peak.a * peak.c);
  real at_x = dot3(s_x, at), at_y = dot3(s_y, at);
  peak.x = min_real(max_real(x + (peak.b * at_y - peak.c * at_x) / peak.det, REAL(-1e3f)), REAL(1e3f));
  peak.y = min_real(max_real(y + (peak.b * at_x - peak.a * at_y) / peak.det, REAL(-1e3f)), REAL(1e3f));
  peak.least = alpha_squared;
  return peak;
}
#endif

SHARED_FUNCTION Real3 side_of_area(LightIndex light, int side AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  Float4 value = COLUMN(Float4, area_sides, AREA_RULE + 3 * light + side);
  return real3(REAL(value.x), REAL(value.y), REAL(value.z));
}

SHARED_FUNCTION bool area_lights_lit(LightIndex light AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  return COLUMN(Float4, area_sides, AREA_RULE + 3 * light).w > 0.0f;
}

// to_light: to the centre, m.
SHARED_FUNCTION SeenArea seen_area(LightIndex light, Real3 to_light AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  SeenArea seen;
  seen.centre = to_light;
  seen.across = side_of_area(light, 0 AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  seen.up = side_of_area(light, 1 AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  Real3 emits = side_of_area(light, 2 AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  seen.ahead = max_real(-dot3(emits, to_light), REAL(0.0f));
  return seen;
}

#ifdef LAMBERT
#define AREA_VIEWER(p) (p).normal
#else
#define AREA_VIEWER(p) (p).to_viewer
SHARED_FUNCTION Real3 area_lobe(int part, ShadingPoint p, Real3 normal, Real3 to_viewer, Lobe lobe,
                                LightIndex light, SeenArea seen AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  Real3 emits = side_of_area(light, 2 AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  AreaPeak peak = lobe_peak(seen, normal, to_viewer, emits, lobe.alpha_squared);
  return area_sum(part, p, normal, to_viewer, lobe, seen, peak AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
}
#endif

// Per unit of intensity along the light's direction.
SHARED_FUNCTION Real3 area_lights_radiance(LightIndex light, ShadingPoint p,
                                           Real3 to_light AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  SeenArea seen = seen_area(light, to_light AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
#ifdef LAMBERT
  Lobe lobe;  // is not read
  lobe.alpha = REAL(0.0f);
#else
  Lobe lobe = p.lobe;
#endif
  Real3 back = area_sum(AREA_DIFFUSE, p, p.normal, AREA_VIEWER(p), lobe, seen,
                        falloff_peak(seen) AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
#ifndef LAMBERT
  Real3 own =
      area_lobe(AREA_LOBE, p, p.normal, p.to_viewer, lobe, light, seen AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
#ifdef SPECULAR
  real rim = p.f90 * own.y;
#else
  real rim = own.y;
#endif
  back = add3(mad3(p.f0, own.x, back), real3(rim, rim, rim));
#ifdef CLEARCOAT
  Real3 over = area_lobe(AREA_LOBE, p, p.coat_normal, p.to_viewer, p.coat_lobe, light,
                         seen AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  real coat = p.coat * over.z;
  back = add3(UNDER_COAT(p, back), real3(coat, coat, coat));
#endif
#endif
  return back;
}

// The sums of a light buffer (shared/light_buffer.h).
SHARED_FUNCTION LitTerms area_lights_terms(LightIndex light, Real3 normal, Real3 to_viewer, real exponent,
                                           Real3 to_light AREA_LIGHTS_LIT_INPUTS(TAKEN_INPUT)) {
  SeenArea seen = seen_area(light, to_light AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  ShadingPoint p;  // is not read
  p.normal = normal;
  Lobe lobe;
  lobe.viewer = exponent;
  lobe.alpha_squared = 2.0f / (exponent + 2.0f);  // shininess_of in reverse
  LitTerms terms;
  Real3 diffuse = area_sum(AREA_COSINE, p, normal, to_viewer, lobe, seen,
                           falloff_peak(seen) AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  terms.diffuse = diffuse.x;
  terms.weight = diffuse.y;
  terms.specular = terms.rim = REAL(0.0f);
#ifndef LAMBERT
  Real3 own =
      area_lobe(AREA_POWER, p, normal, to_viewer, lobe, light, seen AREA_LIGHTS_LIT_INPUTS(PASSED_INPUT));
  terms.specular = own.x;
  terms.rim = own.y;
#endif
  return terms;
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
#endif
