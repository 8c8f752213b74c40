// Radiance of pixels at edges under the sums of light of their samples, for CPUs: a work-item takes a tile,
// 16 surfaces at a time (kernels/resolve/edge_surfaces.h). A surface is resolved once a pixel, at its
// centroid, and shows the mean of its light under the sums of each sample that sees it. Other pixels keep
// their colours.
//
// triangles, depths, edges  as edge_surfaces.h says
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; of the lights only directional ones are read
// background, first, second, scale, exponent, reference  as resolve/cpu/resolve_materials.cl
// image              in and out: RGBA a pixel, linear, row 0 at the bottom
// -DPREPASS_…, -DBUFFER_BITS, and what edge_surfaces.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/edge_surfaces.h"
#include "kernels/resolve/resolve_sums.h"

// The buffer's places of the k-th sample that sees each surface, or of its last one.
static inline void samples_of_batch(size_t* at, const EdgeSurfaces* e, const EdgeBatch* b, uint k) {
  for (uint i = 0; i < 16; ++i) {
    uint left = e->samples[b->surface[i]];
    for (uint skipped = 0; skipped < k && (left & (left - 1)) != 0; ++skipped) left &= left - 1;
    at[i] = (size_t)e->pixel[b->surface[i]] * SAMPLES + lowest_bit(left);
  }
}

kernel void resolve_materials_edges(global const uint* triangles, global const float* depths,
                                    global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                                    global const light_channel_t* first, global const light_channel_t* second,
                                    float scale, float exponent, float reference, global float* image) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const LightBufferParams of = {REAL(exponent), REAL(reference)};
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
  EdgeSurfaces e;
  EdgeBatch b;
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      find_edge_surfaces(&e, triangles, depths, edges, x0, y0, width, height);
      for (uint i = 0; i < e.count; i += 16) {
        take_batch(&b, &e, i, &scene);
        float counts[16];
        uint most = 0;
        for (uint k = 0; k < 16; ++k) {
          const uint count = (uint)popcount((uint)e.samples[b.surface[k]]);
          counts[k] = (float)count, most = max(most, count);
        }
        const real count = vload16(0, counts);
        Real3 shown = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#pragma unroll 1
        for (uint k = 0; k < most; ++k) {
          size_t at[16];
          samples_of_batch(at, &e, &b, k);
          const Real3 one = radiance_of_sums(&b.attributes, &b.material, b.x, b.y, b.depth, b.covered,
                                             stored_sums(first, second, scale, at), of, &lights, view);
          const real share = REAL((float)k) < count ? 1.0f / count : REAL(0.0f);
          shown = add3(shown, real3(one.x * share, one.y * share, one.z * share));
        }
        keep_light(&e, &b, shown);
      }
      show_edges(&e, background, image);
    }
  }
}
