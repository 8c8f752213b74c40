// The surface of every pixel of a visibility buffer into a geometry buffer, for GPUs: a work-item a pixel. As
// resolve/cpu/resolve_gbuffer.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_surface.h"

kernel void resolve_gbuffer(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                            float4 background, SURFACE_IMAGES) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const TexelPlaces place = {(size_t)y * view->width + x, ALL_SAMPLES};
  const uint triangle = triangles[place.pixel];
  const bool covered = triangle != SURFACE_NONE;
  const SurfaceImages images = GIVEN_SURFACE_IMAGES;
  Attributes a = {0};
  Surface s = {0};
  if (covered) {
    const ResolveScene scene = RESOLVE_SCENE;
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
  }
  store_surface(&images, &a, &s, covered, &place);
  if (!image) return;
  float4 shown = background;
  if (covered) {
    ResolveLights lights = RESOLVE_LIGHTS;
    light_pixels(&lights.lights, x, y, view);
    const ShadingPoint p =
        resolved_point(&a, &s, (float)x + 0.5f, (float)y + 0.5f, depths[place.pixel], 1, view);
    const Real3 base = base_light(&p, &s, 1, &lights, view);
    shown = (float4)(base.x, base.y, base.z, 1.0f);
  }
  ((global float4*)image)[place.pixel] = shown;
}
