// Blended surfaces laid over an image in drawing order, for GPUs: a work-item a pixel, record after record of
// its tile. As resolve/cpu/blend.cl, with the same arguments.
#define BLEND  // shared/light_table.h
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/blended_fragments.h"
#include "kernels/resolve/resolve_light.h"
#include "shared/light_grid.h"

#ifdef SHADOWS
#define LAYERS_ARGUMENT uint shadow_layers,
#else
#define LAYERS_ARGUMENT
#endif

kernel void blend(global const RasterRecord* records, global const uint* tile_begin, global const uint* lists,
                  uint tiles_x, global const float* depths, LAYERS_ARGUMENT RESOLVE_ARGUMENTS,
                  global float* image) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint number = y / RASTER_TILE * tiles_x + x / RASTER_TILE;
  const int tile_x = (int)(x / RASTER_TILE * RASTER_TILE), tile_y = (int)(y / RASTER_TILE * RASTER_TILE);
  const int dx = (int)(x & 3u), dy = (int)(y & 3u), bx = (int)x - tile_x - dx, by = (int)y - tile_y - dy;
  const size_t at = (size_t)y * view->width + x;
  const OpaqueDepth opaque = OPAQUE_DEPTH(depths, at);
#if SAMPLES > 1
  float share;
#endif
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, cell_of_pixel(x, y, view->tile_size, view->tiles_x), view);
  float4 under = ((global const float4*)image)[at];
#ifdef SHADOWS
  light_pixels(&lights.lights, x, y, view);
  int layer = 0;
#endif
  for (uint i = tile_begin[number]; i < tile_begin[number + 1]; ++i) {
    const TileRecord r = in_tile(records + lists[i], tile_x, tile_y);
    float depth;
    if (!is_fragment(&r, bx, by, dx, dy, opaque, &depth SHARE_TO(share))) continue;
#ifdef SHADOWS
    light_layers(&lights.lights, layer++, 1, shadow_layers);
#endif
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, r.triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)dx, (float)dy);
    add_material(&s, &a, &scene, (uint)a.material, 1);
    if (s.alpha == 0.0f) continue;  // shows nothing
    const Resolved resolved = resolved_at(&a, &s, x, y, depth, 1);
    const Real3 color = radiance(&resolved, &lights, bin_edges, view);
#if SAMPLES > 1
    s.alpha *= share;
#endif
    under = blended((float4)(color.x, color.y, color.z, 1.0f), s.alpha, under);
  }
  ((global float4*)image)[at] = under;
}
