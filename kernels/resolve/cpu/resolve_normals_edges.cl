// The normals of pixels at edges into an image of samples, for CPUs: each surface's once a pixel, as
// resolve/cpu/resolve_gbuffer_edges.cl stores surfaces. Other pixels, and samples without a surface, keep
// what resolve_normals stored.
//
// triangles, depths, edges  kernels/resolve/edge_surfaces.h
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; no lights are read
// normals            in and out: a sample each (shared/stored_normal.h)
// -DNORMALS_…, and what edge_surfaces.h and resolve.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/edge_surfaces.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_normals.h"

kernel void resolve_normals_edges(global const uint* triangles, global const float* depths,
                                  global const ushort* edges, RESOLVE_ARGUMENTS,
                                  global normal_t* normals GROUP_NUMBERS_OUT) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  EdgeSurfaces e;
  EdgeBatch b;
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      find_edge_surfaces(&e, triangles, depths, edges, x0, y0, width, height);
      for (uint i = 0; i < e.count; i += 16) {
        take_batch(&b, &e, i, &scene);
        const TexelPlaces places = texels_of_batch(&e, i);
        store_normals(normals, shading_normal(&b.attributes, &b.material), b.covered, &places);
#ifdef GROUP_NUMBERS
        store_group_numbers(group_numbers, b.attributes.group_number, b.covered, &places);
#endif
      }
    }
  }
}
