// The normal of every pixel of a visibility buffer, for GPUs: a work-item a pixel. As resolve/cpu/resolve_normals.cl,
// with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_normals.h"

kernel void resolve_normals(global const uint* triangles, RESOLVE_ARGUMENTS,
                            global normal_t* normals GROUP_NUMBERS_OUT) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const TexelPlaces place = {(size_t)y * view->width + x, ALL_SAMPLES};
  const uint triangle = triangles[place.pixel];
  const bool covered = triangle != SURFACE_NONE;
  Attributes a = {0};
  Surface s = {0};
  if (covered) {
    const ResolveScene scene = RESOLVE_SCENE;
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
  }
  store_normals(normals, shading_normal(&a, &s), covered, &place);
#ifdef GROUP_NUMBERS
  store_group_numbers(group_numbers, a.group_number, covered, &place);
#endif
}
