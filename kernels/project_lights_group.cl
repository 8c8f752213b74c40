// Lights to view space, for GPUs: one work-item a light.
//
// lights    as kernels/common/light_arrays.h says
// views     VIEW_ARRAYS arrays of light_stride each
// counters  [0], [1], [3], [4], [5] set to 0, for the kernels that follow
#define LANES 1
#include "kernels/common/light_arrays.h"

kernel void project_lights_group(global const float* lights, global float* views, global uint* counters,
                                 constant CullParams* p) {
  const uint light = get_global_id(0);
  const size_t stride = p->light_stride;
  if (light == 0) counters[0] = counters[1] = counters[3] = counters[4] = counters[5] = 0;
  if (light >= stride) return;
  global const float* l = lights + light;
  const float radius = l[3 * stride];
  const ViewSphere s = view_sphere(l[0], l[stride], l[2 * stride], radius, p);
  const TileRect rect = tile_rect(s, radius, p);
  global float* v = views + light;
  v[VIEW_X * stride] = s.x, v[VIEW_Y * stride] = s.y, v[VIEW_D * stride] = s.d, v[VIEW_R * stride] = s.r;
  v[VIEW_FIRST * stride] = as_float(rect.first), v[VIEW_LAST * stride] = as_float(rect.last);
  v[VIEW_ID * stride] = as_float(light);
#ifdef SPOTS
  const ViewCone k = view_cone(l, stride, p);
  v[VIEW_CONE * stride] = k.x, v[(VIEW_CONE + 1) * stride] = k.y;
  v[(VIEW_CONE + 2) * stride] = k.d, v[(VIEW_CONE + 3) * stride] = k.cosine;
#endif
}
