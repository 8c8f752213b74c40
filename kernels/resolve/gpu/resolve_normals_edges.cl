// The normals of pixels at edges into an image of samples, for GPUs: a work-item a pixel, surface after
// surface. As resolve/cpu/resolve_normals_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/pixel_surfaces.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_normals.h"

kernel void resolve_normals_edges(global const uint* triangles, global const float* depths,
                                  global const ushort* edges, RESOLVE_ARGUMENTS,
                                  global normal_t* normals GROUP_NUMBERS_OUT) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!at_edge(edges, at)) return;
  const ResolveScene scene = RESOLVE_SCENE;
  uint left = ALL_SAMPLES & ~missed_samples(triangles, at);
  while (left != 0) {
    const ResolvedSurface r = next_resolved(triangles, depths, at, &left, x, y, &scene);
    const TexelPlaces places = {at, r.samples};
    store_normals(normals, shading_normal(&r.attributes, &r.material), 1, &places);
#ifdef GROUP_NUMBERS
    store_group_numbers(group_numbers, r.attributes.group_number, 1, &places);
#endif
  }
}
