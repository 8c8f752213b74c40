// The light table: what shading reads of the point and spot lights, one array a column, lights in the order
// of FramePlan::local. A row of LIGHT_TABLE is all that shaders, kernels and uploads know of a column; the
// function of its member's name in renderer/light_table.cpp makes its values.
//   SPOTS: at least one light has a cone.
//   LIGHT_REACHES: the frame plan names an effect that asks light_reaches.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Columns that are there only under a condition are written as IF_SPOTS(text).
#define IF_LIGHTS(text) text
#ifdef SPOTS
#define IF_SPOTS(text) text
#else
#define IF_SPOTS(text)
#endif

// ROW(condition, type, member of PunctualLight, array, sampler of the array in GLSL, its texture unit)
//   position  view space, and 1 / radius^2 (next to 0: no range)
//   color     radiant intensity, and the least 1 / distance^2
//   cone      axis times scale, and offset: 1 inside, 0 outside
#define LIGHT_TABLE(ROW)                                              \
  ROW(IF_LIGHTS, Float4, position, light_positions, samplerBuffer, 8) \
  ROW(IF_LIGHTS, Float4, color, light_colors, samplerBuffer, 9)       \
  ROW(IF_SPOTS, Float4, cone, light_cones, samplerBuffer, 10)

#define LIGHT_MEMBER(condition, type, member, array, sampler, unit) condition(type member;)
SHARED_STRUCT(PunctualLight){LIGHT_TABLE(LIGHT_MEMBER)};

#if defined(LIGHTGRID_GLSL)
#define LIGHT_TEXTURE(condition, type, member, array, sampler, unit) \
  condition(layout(binding = unit) uniform sampler array;)
#define LIGHT_TEXEL(condition, type, member, array, sampler, unit) \
  condition(light.member = type(texelFetch(array, index));)
#elif defined(__OPENCL_VERSION__)
// Arguments of a kernel, before others; those without their condition are not read. Then the same as members
// of a struct, and as their first values.
#define LIGHT_ARGUMENT(condition, type, member, array, sampler, unit) global const type *array,
#define LIGHT_ARGUMENTS LIGHT_TABLE(LIGHT_ARGUMENT)
#define LIGHT_ARRAY(condition, type, member, array, sampler, unit) global const type* array;
#define LIGHT_GIVEN(condition, type, member, array, sampler, unit) array,
#define GIVEN_LIGHTS LIGHT_TABLE(LIGHT_GIVEN)
#define LIGHT_ELEMENT(condition, type, member, array, sampler, unit) \
  condition(light.member = lights->array[index];)
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
