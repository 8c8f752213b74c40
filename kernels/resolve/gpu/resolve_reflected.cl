// What each pixel of a light's view reflects of that light, for GPUs: a work-item a pixel. As
// resolve/cpu/resolve_reflected.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/reflected_light.h"

kernel void resolve_reflected(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                              uint light, global float* flux, global float* places) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  float4 reflected = 0.0f, place = 0.0f;
  if (triangle != SURFACE_NONE) {
    const ResolveScene scene = RESOLVE_SCENE;
    const ResolveLights lights = RESOLVE_LIGHTS;
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
    const ShadingPoint p =
        resolved_point(&a, &s, (float)x + 0.5f, (float)y + 0.5f, depths[at], 1, view);
    Real3 plane = real3(0.0f, 0.0f, 0.0f);
    add_plane(&plane, &scene, triangle, 1, view);
    const ReflectedLight r =
        reflected_light(p, s.unlit, plane, 1, light_at(&lights.lights, light), view);
    reflected = (float4)(r.flux.x, r.flux.y, r.flux.z, r.area);
    place = (float4)(r.normal.x, r.normal.y, r.normal.z, r.ahead);
  }
  ((global float4*)flux)[at] = reflected;
  ((global float4*)places)[at] = place;
}
