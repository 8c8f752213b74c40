// The values of a surface that effects read: one for each row of NAME_SURFACE_INPUTS (shared/inputs.h), as a
// member of this name. Draws, records of instances and geometry buffers have the number of a surface
// (MaskPlan::of_instance). Its values are looked up once for each point that is shaded.
#pragma once

#include "shared/effect_surfaces.h"
#include "shared/inputs.h"

#ifdef HAS_SURFACE_VALUES
#define SURFACE_VALUE(kind, type, name, resource) Whole name;
#define SURFACE_MEMBERS(inputs, effect, own) inputs(SURFACE_VALUE)
SHARED_STRUCT(SurfaceValues){SURFACE_EFFECTS(SURFACE_MEMBERS)};
#define VALUES_AT(p) ((p).surface)
#else
#define SurfaceValues Whole
#define VALUES_AT(p) WHOLE(0)
#endif

#if defined(LIGHTGRID_GLSL)
#define SURFACE_UNIFORMS(inputs, effect, own) inputs(INPUT_UNIFORM)
SURFACE_EFFECTS(SURFACE_UNIFORMS)
SurfaceValues values_of_surface(int number) {
#ifdef HAS_SURFACE_VALUES
#define READ_VALUE(kind, type, name, resource) values.name = int(COLUMN(type, name, number));
#define READ_VALUES(inputs, effect, own) inputs(READ_VALUE)
  SurfaceValues values;
  SURFACE_EFFECTS(READ_VALUES)
  return values;
#else
  return 0;
#endif
}
#elif defined(HAS_SURFACE_VALUES)
// By number.
typedef struct SurfaceArrays {
  SURFACE_EFFECTS(EFFECT_MEMBERS)
} SurfaceArrays;
#define GIVEN_SURFACE_ARRAYS \
  { SURFACE_EFFECTS(EFFECT_VALUES) }
#endif
