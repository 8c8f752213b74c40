// An effect (src/engine/effects) declares the inputs that light loops read for it in one list of rows. From
// the list follow the parameters of kernels and members of their structs, the samplers and uniform blocks of
// shaders, and in C++ memory, binding and byte counts (renderer/loop_inputs.h).
//
//   #define NAME_HOOK_INPUTS(ROW) ROW(kind, type, name, resource) ...
//   ArrayInput   many values: in kernels a pointer to `type`, in shaders a texture of the sampler type
//                `resource`
//   ColumnInput  a number of values for each light, such as a column of LIGHT_TABLE: in kernels a pointer to
//                `type`, in shaders a buffer texture; COLUMN(type, name, i) is value i. A table, such as the
//                texels of cookies, is one too: LOOKUP(name, i) is the float at i, which each pixel has its
//                own; LOOKUP_WORD(name, i) the Whole with the bits of the uint at i
//   BlockInput   one struct: in kernels a pointer to it, in shaders the member `name` of the uniform block
//                `resource`
//
// Functions that read inputs end their parameters with NAME_HOOK_INPUTS(TAKEN_INPUT) and are called with
// NAME_HOOK_INPUTS(PASSED_INPUT); INPUT(name) is a block's struct. The list's name says which hook the text
// answers. A text may answer several.
//   NAME_BASE_INPUTS   Real3 NAME_base(ShadingPoint p, real occlusion, Lit lit, inputs): the light that a
//                      surface shows besides that of the scene's lights. occlusion: the part of light from
//                      all sides that its occlusion map leaves
//   NAME_BACKGROUND_INPUTS  Real3 NAME_background(Real3 direction, inputs): the radiance that is seen past all
//                      surfaces, in place of the scene's background. direction: from the eye, in view space.
//                      The inputs are some of NAME_BASE_INPUTS; one effect at most has a background
//   NAME_REACH_INPUTS  real NAME_reach(LightIndex light, Real3 point, Real3 to_light, inputs): the part of a
//                      light, 0 to 1, that passes to a point of a surface (light_reaches in
//                      shared/light_table.h). light: its place among point and spot lights; directional ones
//                      follow. point and the unit vector to_light: in view space.
//   NAME_TINT_INPUTS   Real3 NAME_tint(LightIndex light, Real3 point, Real3 to_light, inputs): the same for
//                      red, green and blue. A light's color is multiplied by it (Arrival::tint).
//   NAME_MEETS_INPUTS  Lit NAME_meets(LightIndex light, inputs): the same where the part is 0 or 1 at all
//   points
//                      of a surface. Light loops leave a light out before they compute its distance.
//   NAME_LIT_INPUTS    the light of a shape in place of a point's. Three functions:
//                      bool NAME_lit(LightIndex light, inputs): whether the light has the shape;
//                      Real3 NAME_radiance(LightIndex light, ShadingPoint p, Real3 to_light, inputs): what p
//                      reflects per unit of the light's intensity, without the light's window, cone and
//                      shadow. to_light: from p to the light's position, in view space, not of length 1;
//                      LitTerms NAME_terms(LightIndex light, Real3 normal, Real3 to_viewer, real exponent,
//                      Real3 to_light, inputs): the same for light buffers (shared/light_buffer.h)
//
// The values that an effect reads of a surface are a separate list, NAME_SURFACE_INPUTS, of ColumnInputs with one value
// of 32 bits for each number of a surface (shared/surface_values.h). Functions of hooks end their parameters
// with NAME_SURFACE_INPUTS(TAKEN_VALUE), and get the values at the point. The program declares the inputs. It
// finds the list in the text before it compiles: the list must not stand under a condition.
//
// "shared/effects.h" includes the effects that a program has and defines BASE_EFFECTS(X), which is
// X(NAME_BASE_INPUTS, NAME_base, list of surface inputs) for each that has this list, and REACH_EFFECTS(X),
// MEETS_EFFECTS(X), LIT_EFFECTS(X), RADIANCE_EFFECTS(X), TERMS_EFFECTS(X) and SURFACE_EFFECTS(X) likewise.
#pragma once

#include "shared/real.h"

// The values of a surface for a hook.
#define VALUE_OF_SURFACE(kind, type, name, resource) , surface.name

#if defined(__OPENCL_VERSION__)
#define Lit mask_t  // of each lane, whether a surface is lit there
#define EVERY_LIT WHOLE(-1)
#define BOTH(a, b) ((a) & (b))
#define ANY(lit) any_lane(lit)
#define INPUT(name) (*name)
#define LightIndex uint
#define ArrayInput(type) global const type*
#define ColumnInput(type) global const type*
#define COLUMN(type, name, i) ((type)((name)[i]))
#if LANES == 16
#define LOOKUP(name, i)                                                                                   \
  ((real)((name)[(i).s0], (name)[(i).s1], (name)[(i).s2], (name)[(i).s3], (name)[(i).s4], (name)[(i).s5], \
          (name)[(i).s6], (name)[(i).s7], (name)[(i).s8], (name)[(i).s9], (name)[(i).sa], (name)[(i).sb], \
          (name)[(i).sc], (name)[(i).sd], (name)[(i).se], (name)[(i).sf]))
// The floats at i and after it. One load of both per lane takes half the time of two lookups.
#define LOOKUP_PAIR(name, i, low, high)                                                                     \
  float2 p0 = vload2(0, (name) + (i).s0), p1 = vload2(0, (name) + (i).s1), p2 = vload2(0, (name) + (i).s2), \
         p3 = vload2(0, (name) + (i).s3), p4 = vload2(0, (name) + (i).s4), p5 = vload2(0, (name) + (i).s5), \
         p6 = vload2(0, (name) + (i).s6), p7 = vload2(0, (name) + (i).s7), p8 = vload2(0, (name) + (i).s8), \
         p9 = vload2(0, (name) + (i).s9), pa = vload2(0, (name) + (i).sa), pb = vload2(0, (name) + (i).sb), \
         pc = vload2(0, (name) + (i).sc), pd = vload2(0, (name) + (i).sd), pe = vload2(0, (name) + (i).se), \
         pf = vload2(0, (name) + (i).sf);                                                                   \
  low = (real)(p0.x, p1.x, p2.x, p3.x, p4.x, p5.x, p6.x, p7.x, p8.x, p9.x, pa.x, pb.x, pc.x, pd.x, pe.x,    \
               pf.x);                                                                                       \
  high =                                                                                                    \
      (real)(p0.y, p1.y, p2.y, p3.y, p4.y, p5.y, p6.y, p7.y, p8.y, p9.y, pa.y, pb.y, pc.y, pd.y, pe.y, pf.y)
#else
#define LOOKUP(name, i) (name)[i]
#define LOOKUP_PAIR(name, i, low, high) low = (name)[i], high = (name)[(i) + 1]
#endif
#define LOOKUP_WORD(name, i) bits_of_real(LOOKUP((global const float*)(name), i))
#define BlockInput(type) constant type*
#define TAKEN_INPUT(kind, type, name, resource) , kind(type) name
#define TAKEN_VALUE(kind, type, name, resource) , Whole name
#define PASSED_INPUT(kind, type, name, resource) , name
#define INPUT_UNIFORM(kind, type, name, resource)
// A kernel's parameters, members and values: BASE_EFFECTS and its like of EFFECT_PARAMETERS, _MEMBERS and
// _VALUES.
#define INPUT_PARAMETER(kind, type, name, resource) kind(type) name,
#define INPUT_MEMBER(kind, type, name, resource) kind(type) name;
#define INPUT_VALUE(kind, type, name, resource) .name = name,
#define EFFECT_PARAMETERS(inputs, hook, surface) inputs(INPUT_PARAMETER)
#define EFFECT_MEMBERS(inputs, hook, surface) inputs(INPUT_MEMBER)
#define EFFECT_VALUES(inputs, hook, surface) inputs(INPUT_VALUE)
#elif defined(LIGHTGRID_GLSL)
#define Lit bool
#define EVERY_LIT true
#define BOTH(a, b) ((a) && (b))
#define ANY(lit) (lit)
#define INPUT(name) name
#define LightIndex int
#define ArrayInput(type, name, resource) uniform resource name;
#define ColumnInput(type, name, resource) uniform resource name;
#define COLUMN(type, name, i) type(texelFetch(name, i))
#define LOOKUP(name, i) texelFetch(name, i).r
#define LOOKUP_PAIR(name, i, low, high) low = texelFetch(name, i).r, high = texelFetch(name, i + 1).r
#define LOOKUP_WORD(name, i) int(texelFetch(name, i).r)
#define BlockInput(type, name, resource) \
  layout(std140) uniform resource { type name; };
#define TAKEN_INPUT(kind, type, name, resource)
#define TAKEN_VALUE(kind, type, name, resource) , Whole name
#define PASSED_INPUT(kind, type, name, resource)
#define INPUT_UNIFORM(kind, type, name, resource) kind(type, name, resource)
#endif

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif
// Channels of a light buffer per unit of intensity (LightTerms in shared/light_buffer.h).
SHARED_STRUCT(LitTerms) { real diffuse, specular, weight, rim; };
#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
