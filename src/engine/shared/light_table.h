// The light table: what shading reads of the point and spot lights, one array a column, lights in the order
// of LightPlan::local. A row of LIGHT_TABLE is all that shaders, kernels and uploads know of a column; the
// function of its member's name in renderer/upload/lights.cpp makes its values.
//   SPOTS: at least one light has a cone.
//   VIRTUAL_LIGHTS: at least one of those is a virtual point light.
//   SHADOWS: some light of the scene casts a shadow (ShadowPlan::light_reaches).
//   EFFECT_NAME: an effect answers NAME_reach (shared/inputs.h).
//   LIGHTS_IN_BLOCK: shaders read them from a uniform block (Trebilco's constant buffer).
#pragma once

#include "shared/real.h"
#ifdef SHADOWS
#include "shared/shadow_bits.h"
#endif
#if defined(__OPENCL_VERSION__) || defined(LIGHTGRID_GLSL)
#include "shared/effects.h"
#include "shared/surface_values.h"
#endif

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
#ifdef VIRTUAL_LIGHTS
#define IF_VIRTUAL(text) text
#else
#define IF_VIRTUAL(text)
#endif

// ROW(condition, type, member of PunctualLight, array, type of its texture in GLSL)
//   position  view space, and 1 / radius^2 (next to 0: no range)
//   color     radiant intensity, and the least 1 / distance^2
//   cone      axis times scale, and offset: 1 inside, 0 outside
//   max_falloff  of a virtual light, which fades with the cone's cosine itself and not with its square: the
//             most 1 / distance^2; 0 of other lights
//   groups    a bit each. After all lights follow directional ones, and then the masks of instances, by
//             MaskPlan::values
#define LIGHT_TABLE(ROW)                                           \
  ROW(IF_LIGHTS, Float4, position, light_positions, samplerBuffer) \
  ROW(IF_LIGHTS, Float4, color, light_colors, samplerBuffer)       \
  ROW(IF_SPOTS, Float4, cone, light_cones, samplerBuffer)          \
  ROW(IF_VIRTUAL, float, max_falloff, light_falloffs, samplerBuffer)

// The block's columns fit into the 16 KB that OpenGL guarantees.
#define LIGHTS_OF_BLOCK 255

// Identifies a light for light_reaches: its index, and in OpenCL the shadows at the pixels that read it and
// the inputs of effects.
#if defined(REACHED_BY_EFFECTS) || defined(TINTED_BY_EFFECTS) || defined(MET_BY_EFFECTS) || \
    defined(LIT_BY_EFFECTS)
#define EFFECTS_OF_LIGHTS
#endif
#if defined(SHADOWS) || defined(EFFECTS_OF_LIGHTS)
#define HAS_LIGHT_INDEX
#define INDEX_MEMBER LightIndex index;
#else
#define INDEX_MEMBER
#endif
#if defined(SHADOWS) && defined(__OPENCL_VERSION__)
#define SHADOW_MEMBER const ShadowsHere* shadows;
#else
#define SHADOW_MEMBER
#endif
#if defined(EFFECTS_OF_LIGHTS) && defined(__OPENCL_VERSION__)
typedef struct ReachInputs {
  LIT_EFFECTS(EFFECT_MEMBERS)
  REACH_EFFECTS(EFFECT_MEMBERS) TINT_EFFECTS(EFFECT_MEMBERS) MEETS_EFFECTS(EFFECT_MEMBERS)
} ReachInputs;
#define REACH_MEMBER const ReachInputs* reach;
#define LIGHTS_REACH ReachInputs reach;  // of structs of lights, after LIGHT_TABLE(LIGHT_ARRAY)
#define GIVEN_REACH                                                                    \
  {LIT_EFFECTS(EFFECT_VALUES) REACH_EFFECTS(EFFECT_VALUES) TINT_EFFECTS(EFFECT_VALUES) \
       MEETS_EFFECTS(EFFECT_VALUES)},
#define REACH_ARGUMENTS LIGHT_EFFECTS(EFFECT_PARAMETERS)
#else
#define REACH_MEMBER
#define LIGHTS_REACH
#define GIVEN_REACH
#define REACH_ARGUMENTS
#endif

#define LIGHT_MEMBER(condition, type, member, array, texels) condition(type member;)
SHARED_STRUCT(PunctualLight){LIGHT_TABLE(LIGHT_MEMBER) INDEX_MEMBER SHADOW_MEMBER REACH_MEMBER};

// The end of every light loop: how much of a light reaches a point of a surface, 0 to 1, besides what
// distance and cone let through. Shadows answer here, for the pixel that is shaded, and the effects that
// answer NAME_meets or NAME_reach (shared/inputs.h). The plan says who answers (FramePlan::light_reaches and
// ::effects); without any the factor is the constant 1, which compiles to nothing.
//   point: along the axes of light.position, which are the view's. to_light: of length 1, likewise.
//   surface: its values (shared/surface_values.h). Forward shaders look them up for each draw, resolve
//   kernels by the instance's record, both by way of ShadingPoint; code that reads a geometry buffer, by the
//   number in it.
#if defined(SHADOWS) && defined(LIGHTGRID_GLSL)
#define SEEN_SHARE(light) seen_share((light).index, uvec2(gl_FragCoord.xy))
#elif defined(SHADOWS) && defined(__OPENCL_VERSION__)
#define SEEN_SHARE(light) seen_share((light).shadows, (light).index)
#else
#define SEEN_SHARE(light) REAL(1.0f)
#endif

// Returns whether all effects let a light reach a surface, and the share that reaches a point of it.
#ifdef __OPENCL_VERSION__
#define INPUT_OF_REACH(kind, type, name, resource) , from->name
#define LIGHT_OF_EFFECTS const ReachInputs *from, uint light,
#define OF_LIGHT(light) (light).reach, (light).index
#else
#define INPUT_OF_REACH(kind, type, name, resource)
#define LIGHT_OF_EFFECTS int light,
#define OF_LIGHT(light) (light).index
#endif
#ifdef MET_BY_EFFECTS
#define AND_MEETS(inputs, meets, own) \
  met = BOTH(met, meets(light inputs(INPUT_OF_REACH) own(VALUE_OF_SURFACE)));
SHARED_FUNCTION Lit effects_meet(LIGHT_OF_EFFECTS SurfaceValues surface) {
  Lit met = EVERY_LIT;
  MEETS_EFFECTS(AND_MEETS)
  return met;
}
#define IF_MEETING(light, surface, share) (effects_meet(OF_LIGHT(light), surface) ? (share) : REAL(0.0f))
#else
#define IF_MEETING(light, surface, share) (share)
#endif
#ifdef LIT_BY_EFFECTS
// Returns whether an effect computes the light in place of a point's formula.
#define OR_LIT(inputs, lit, own) found = found || lit(light inputs(INPUT_OF_REACH));
SHARED_FUNCTION bool effects_light(LIGHT_OF_EFFECTS bool found) {
  LIT_EFFECTS(OR_LIT)
  return found;
}
#define ADD_RADIANCE(inputs, radiance, own) \
  sum = add3(sum, radiance(light, p, to_light inputs(INPUT_OF_REACH)));
SHARED_FUNCTION Real3 effects_radiance(LIGHT_OF_EFFECTS ShadingPoint p, Real3 to_light) {
  Real3 sum = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
  RADIANCE_EFFECTS(ADD_RADIANCE)
  return sum;
}
#define ADD_TERMS(inputs, terms, own)                                                \
  more = terms(light, normal, to_viewer, exponent, to_light inputs(INPUT_OF_REACH)); \
  sum.diffuse = sum.diffuse + more.diffuse;                                          \
  sum.specular = sum.specular + more.specular;                                       \
  sum.weight = sum.weight + more.weight;                                             \
  sum.rim = sum.rim + more.rim;
SHARED_FUNCTION LitTerms effects_terms(LIGHT_OF_EFFECTS Real3 normal, Real3 to_viewer, real exponent,
                                       Real3 to_light) {
  LitTerms sum, more;
  sum.diffuse = sum.specular = sum.weight = sum.rim = REAL(0.0f);
  TERMS_EFFECTS(ADD_TERMS)
  return sum;
}
#endif
#ifdef REACHED_BY_EFFECTS
#define TIMES_REACH(inputs, reach, own) \
  share = share * reach(light, point, to_light inputs(INPUT_OF_REACH) own(VALUE_OF_SURFACE));
SHARED_FUNCTION real effects_reach(LIGHT_OF_EFFECTS Real3 point, Real3 to_light, SurfaceValues surface) {
  real share = REAL(1.0f);
  REACH_EFFECTS(TIMES_REACH)
  return share;
}
#define light_reaches(light, point, to_light, surface) \
  IF_MEETING(light, surface, SEEN_SHARE(light) * effects_reach(OF_LIGHT(light), point, to_light, surface))
#elif defined(LIGHTGRID_GLSL) || defined(__OPENCL_VERSION__)
#define light_reaches(light, point, to_light, surface) IF_MEETING(light, surface, SEEN_SHARE(light))
#else
inline real light_reaches(const PunctualLight&, const Real3&, const Real3&, Whole) { return 1; }
#endif

// The tint of all effects. TINT sets that of an Arrival (shared/punctual_light.h), once it is known to be lit;
// TINTED multiplies one channel of a light's color by it.
#ifdef TINTED_BY_EFFECTS
#define TIMES_TINT(inputs, tint, own)                                               \
  more = tint(light, point, to_light inputs(INPUT_OF_REACH) own(VALUE_OF_SURFACE)); \
  all = real3(all.x * more.x, all.y * more.y, all.z * more.z);
SHARED_FUNCTION Real3 effects_tint(LIGHT_OF_EFFECTS Real3 point, Real3 to_light, SurfaceValues surface) {
  Real3 all = real3(REAL(1.0f), REAL(1.0f), REAL(1.0f)), more;
  TINT_EFFECTS(TIMES_TINT)
  return all;
}
#define TINT(arrival, light, point, surface) \
  (arrival).tint = effects_tint(OF_LIGHT(light), point, (arrival).to_light, surface);
#define TINTED(arrival, channel) *(arrival).tint.channel
#else
#define TINT(arrival, light, point, surface)
#define TINTED(arrival, channel)
#endif

#if defined(LIGHTGRID_GLSL)
// From buffer textures; with LIGHTS_IN_BLOCK from a uniform block, which has all columns.
#ifdef LIGHTS_IN_BLOCK
#define LIGHT_INPUT(condition, type, member, array, texels) type array[LIGHTS_OF_BLOCK];
#define LIGHT_VALUE(type, array, index) array[index]
#else
#define LIGHT_INPUT(condition, type, member, array, texels) condition(uniform texels array;)
#define LIGHT_VALUE(type, array, index) type(texelFetch(array, index))
#endif
#define LIGHT_TEXEL(condition, type, member, array, texels) \
  condition(light.member = LIGHT_VALUE(type, array, index);)
#elif defined(__OPENCL_VERSION__)
// Arguments of a kernel, before others; those without their condition are not read, and shadows not there.
// Then the same as members of a struct, and as their first values.
#define LIGHT_ARGUMENT(condition, type, member, array, texels) global const type *array,
#ifndef SHADOWS
#define SHADOW_ARGUMENTS
#define GIVEN_SHADOWS
#endif
#define LIGHT_ARGUMENTS LIGHT_TABLE(LIGHT_ARGUMENT) REACH_ARGUMENTS SHADOW_ARGUMENTS
#define LIGHT_ARRAY(condition, type, member, array, texels) global const type* array;
#define LIGHT_GIVEN(condition, type, member, array, texels) array,
#define GIVEN_LIGHTS LIGHT_TABLE(LIGHT_GIVEN) GIVEN_REACH
#define LIGHT_ELEMENT(condition, type, member, array, texels) condition(light.member = lights->array[index];)
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
