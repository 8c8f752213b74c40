// The corners of all triangles of the rays' scene by number, for shaders: an item a triangle.
//
// RAYS_ARGUMENTS  the triangles
// corners         out: three float4 each, x y z relative to the scene's origin
#define LANES 1
#include "kernels/rays/rays.h"

kernel void ray_corners(RAYS_ARGUMENTS, global float4* corners) {
  const RayScene scene = RAYS_SCENE;
  const size_t number = get_global_id(0);
  float of[9];
  rays_triangle(&scene, (uint)number, of);
  for (int k = 0; k < 3; ++k)
    corners[number * 3 + k] = (float4)(of[3 * k], of[3 * k + 1], of[3 * k + 2], 0.0f);
}
