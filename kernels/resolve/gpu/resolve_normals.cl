// The normal of every pixel of a visibility buffer, for GPUs: a work-item a pixel. As resolve/cpu/resolve_normals.cl,
// with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/stored_normals.h"

kernel void resolve_normals(global const uint* triangles, RESOLVE_ARGUMENTS,
                            global normal_t* normals GROUP_NUMBERS_OUT) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  Real3 n = real3(0.0f, 0.0f, 1.0f);
  uint group = 0;
  if (triangle != SURFACE_NONE) {
    const ResolveScene scene = RESOLVE_SCENE;
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
    n = shading_normal(&a, &s);
#ifdef GROUP_NUMBERS
    group = (uint)a.group_number;
#endif
  }
#ifdef GROUP_NUMBERS
  group_numbers[at] = (group_number_t)group;
#endif
#ifdef NORMAL_CHANNEL_STEPS
  normals[at] = packed_normal(n);
#else
  normals[at] = (float4)(n.x, n.y, n.z, 0.0f);
#endif
}
