// Light groups (docs/light_groups.md): lights and surfaces have masks of 32 groups, and a light reaches a
// surface where they share one.
#pragma once

#include "shared/inputs.h"

#define LIGHT_GROUPS_MEETS_INPUTS(ROW) ROW(ColumnInput, uint, light_groups, usamplerBuffer)
#define LIGHT_GROUPS_SURFACE_INPUTS(ROW) ROW(ColumnInput, uint, surface_groups, usamplerBuffer)

#ifdef EFFECT_LIGHT_GROUPS
#ifdef LIGHTGRID_GLSL
LIGHT_GROUPS_MEETS_INPUTS(INPUT_UNIFORM)
#endif
SHARED_FUNCTION Lit light_groups_meets(LightIndex light LIGHT_GROUPS_MEETS_INPUTS(TAKEN_INPUT)
                                           LIGHT_GROUPS_SURFACE_INPUTS(TAKEN_VALUE)) {
  return (surface_groups & WHOLE(COLUMN(int, light_groups, light))) != WHOLE(0);
}
#endif
