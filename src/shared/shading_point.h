// What is the same for every light at a point: the glTF 2.0 metallic-roughness material (specification, appendix B) seen
// from one side. View space.
#pragma once

#include "shared/real.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

#define SHADING_PI 3.14159265358979f
#define ROUGHNESS_FLOOR 0.045f  // below it GGX's peak leaves the range in which float keeps its shape

SHARED_STRUCT(ShadingPoint) {
  Real3 position, normal, to_viewer;
  Real3 diffuse;  // albedo / pi
  Real3 f0;
  real alpha, alpha_squared;
  real n_dot_v;
  real lobe;  // what the specular lobe needs of viewer and roughness (lobe_of)
};

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
