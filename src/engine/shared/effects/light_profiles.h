// Light profiles: point and spot lights whose intensity depends on direction, as a photometric file says
// (docs/profiles.md).
#pragma once

#include "shared/half_angle.h"
#include "shared/inputs.h"

// Four values for each light, and the grids of all profiles (scene/light_profiles.h). Axes are in view space:
// polar angles are measured from the pole, azimuths from the first axis towards the second.
//   0: pole, and the index of the light's grid in profile_shares; -1: the light has no profile
//   1: first axis, and columns of the grid, steps of a full turn; 0: one column
//   2: second axis, and rows: steps from the first polar angle to the last; negative: 0 behind, where the cosine
//      to the first axis is negative
//   3: first polar angle in radians, rows per radian, cosines of the first and last angle; for 0 and 180
//      degrees: 2 and -2
// A grid is columns of rows + 1 shares.
#define LIGHT_PROFILES_REACH_INPUTS(ROW)                  \
  ROW(ColumnInput, Float4, profile_lights, samplerBuffer) \
  ROW(ColumnInput, float, profile_shares, samplerBuffer)

#ifdef EFFECT_LIGHT_PROFILES
#ifdef LIGHTGRID_GLSL
LIGHT_PROFILES_REACH_INPUTS(INPUT_UNIFORM)
#endif

// The share between the rows at `at` of a column and the next one.
SHARED_FUNCTION real profile_column(Whole at, real weight LIGHT_PROFILES_REACH_INPUTS(TAKEN_INPUT)) {
  real low, high;
  LOOKUP_PAIR(profile_shares, at, low, high);
  return mad_real(weight, high - low, low);
}

SHARED_FUNCTION real light_profiles_reach(LightIndex light, Real3 point,
                                          Real3 to_light LIGHT_PROFILES_REACH_INPUTS(TAKEN_INPUT)) {
  Float4 pole = COLUMN(Float4, profile_lights, light * 4);
  if (pole.w < 0.0f) return REAL(1.0f);
  Float4 first = COLUMN(Float4, profile_lights, light * 4 + 1);
  Float4 second = COLUMN(Float4, profile_lights, light * 4 + 2);
  Float4 ends = COLUMN(Float4, profile_lights, light * 4 + 3);
  real z = -(pole.x * to_light.x + pole.y * to_light.y + pole.z * to_light.z);
  real x = -(first.x * to_light.x + first.y * to_light.y + first.z * to_light.z);
  real y = -(second.x * to_light.x + second.y * to_light.y + second.z * to_light.z);
  real from_pole = sqrt_real(mad_real(x, x, y * y));
  float rows = max(second.w, -second.w);
  // Not past the ends, even if an angle is NaN.
  real down = (angle_from(z, from_pole, REAL(1.0f)) - ends.x) * ends.y;
  down = min_real(max_real(down, REAL(0.0f)), REAL(rows));
  real row = min_real(floor_real(down), REAL(rows - 1.0f));
  Whole at = whole_of_real(row) + whole_of_real(REAL(pole.w));
  real share;
  if (first.w > 0.0f) {
    real half_turn = angle_from(x, max_real(y, -y), from_pole);
    real turn = y < REAL(0.0f) ? REAL(2.0f * HALF_TURN) - half_turn : half_turn;
    real around = turn * (first.w * (0.5f / HALF_TURN));
    around = min_real(max_real(around, REAL(0.0f)), REAL(first.w));
    real column = min_real(floor_real(around), REAL(first.w - 1.0f));
    Whole stride = whole_of_real(REAL(rows + 1.0f));
    at = at + whole_of_real(column) * stride;
    real here = profile_column(at, down - row LIGHT_PROFILES_REACH_INPUTS(PASSED_INPUT));
    real next = profile_column(at + stride, down - row LIGHT_PROFILES_REACH_INPUTS(PASSED_INPUT));
    share = mad_real(around - column, next - here, here);
  } else {
    share = profile_column(at, down - row LIGHT_PROFILES_REACH_INPUTS(PASSED_INPUT));
  }
  share = z > ends.z ? REAL(0.0f) : share;
  share = z < ends.w ? REAL(0.0f) : share;
  if (second.w < 0.0f) share = x < REAL(0.0f) ? REAL(0.0f) : share;
  return share;
}
#endif
