// An effect (src/effects) declares the inputs that light loops read for it in one list of rows. From the list
// follow the parameters of kernels and members of their structs, the samplers and uniform blocks of shaders,
// and in C++ memory, binding and byte counts (renderer/loop_inputs.h).
//
//   #define NAME_INPUTS(ROW) ROW(kind, type, name, resource) ...
//   ArrayInput  many values: in kernels a pointer to `type`, in shaders a texture of the sampler type
//               `resource`
//   BlockInput  one struct: in kernels a pointer to it, in shaders the member `name` of the uniform block
//               `resource`
//
// Functions that read inputs end their parameters with NAME_INPUTS(TAKEN_INPUT) and are called with
// NAME_INPUTS(PASSED_INPUT); INPUT(name) is a block's struct. NAME_base(point, lit, inputs) is the light that
// a surface shows besides that of point and spot lights.
//
// "shared/effects.h" includes the effects that a program has and defines EFFECTS(X): X(NAME_INPUTS,
// NAME_base) for each.
#pragma once

#include "shared/real.h"

#if defined(__OPENCL_VERSION__)
#define Lit mask_t  // of each lane, whether a surface is lit there
#define INPUT(name) (*name)
#define ArrayInput(type) global const type*
#define BlockInput(type) constant type*
#define TAKEN_INPUT(kind, type, name, resource) , kind(type) name
#define PASSED_INPUT(kind, type, name, resource) , name
#define INPUT_UNIFORM(kind, type, name, resource)
// A kernel's parameters, members and values: EFFECTS of EFFECT_PARAMETERS, _MEMBERS and _VALUES.
#define INPUT_PARAMETER(kind, type, name, resource) kind(type) name,
#define INPUT_MEMBER(kind, type, name, resource) kind(type) name;
#define INPUT_VALUE(kind, type, name, resource) .name = name,
#define EFFECT_PARAMETERS(inputs, base) inputs(INPUT_PARAMETER)
#define EFFECT_MEMBERS(inputs, base) inputs(INPUT_MEMBER)
#define EFFECT_VALUES(inputs, base) inputs(INPUT_VALUE)
#elif defined(LIGHTGRID_GLSL)
#define Lit bool
#define INPUT(name) name
#define ArrayInput(type, name, resource) uniform resource name;
#define BlockInput(type, name, resource) \
  layout(std140) uniform resource { type name; };
#define TAKEN_INPUT(kind, type, name, resource)
#define PASSED_INPUT(kind, type, name, resource)
#define INPUT_UNIFORM(kind, type, name, resource) kind(type, name, resource)
#endif
