// Resolves the surfaces of pixels at edges, for CPUs: each once per pixel, at the centroid of the samples
// that see it. A work-item takes a tile in squares of EDGE_BLOCK pixels and resolves their surfaces 16 at a
// time (kernels/resolve/edge_surfaces.h). Other pixels keep what the walker over pixels stored.
//
// triangles, depths, edges  as edge_surfaces.h says
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h
// OUTPUT_ARGUMENTS   kernels/resolve/output.h; the background is that of samples without a surface, and the
//                    image takes the mean over the samples
// -DSHADOWS_TRACED   some light casts a shadow in this view: TRACED_ARGUMENTS come first
//                    (kernels/shadows/traced_shadows.h)
// -DOUTPUT_…, and what edge_surfaces.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/resolve/edge_surfaces.h"

typedef struct Where {
  const EdgeSurfaces* e;
  const EdgeBatch* b;
  uint first;  // surface of the batch
} Where;

static inline TexelPlaces texel_places(const Where* w) { return texels_of_batch(w->e, w->first); }

static inline real seen_samples(const Where* w, uint* most) {
  float counts[16];
  *most = 0;
  for (uint i = 0; i < 16; ++i) {
    const uint count = (uint)popcount((uint)w->e->samples[w->b->surface[i]]);
    counts[i] = (float)count;
    *most = max(*most, count);
  }
  return vload16(0, counts);
}

static inline void places_of_samples(size_t* at, const Where* w, uint k) {
  for (uint i = 0; i < 16; ++i) {
    uint left = w->e->samples[w->b->surface[i]];
    for (uint skipped = 0; skipped < k && (left & (left - 1)) != 0; ++skipped) left &= left - 1;
    at[i] = (size_t)w->e->pixel[w->b->surface[i]] * SAMPLES + lowest_bit(left);
  }
}

#include "kernels/resolve/output.h"
#include "kernels/resolve/traced_edges.h"

// The averages of the light of pixels' surfaces into the image.
static inline void show_edges(const EdgeSurfaces* e, float4 background, global float* image,
                              const ResolveLights* lights, constant ViewParams* view) {
  for (uint i = 0, one = 0; i < e->pixel_count; ++i) {
    float4 color = (float4)(0.0f);
    if (e->missed[i])
      color = begun_with(background_of(background, e->pixels[i], lights, view), share_of(e->missed[i]));
    for (; one < e->ends[i]; ++one)
      color = add_light(color, (float3)(e->red[one], e->green[one], e->blue[one]), share_of(e->samples[one]));
    vstore4(averaged(color), e->pixels[i], image);
  }
}

#ifdef SHADOWS_TRACED
static inline void trace_from_batch(TracedShadows* traced, const EdgeBatch* b, const ResolveScene* scene,
                                    constant ViewParams* view) {
  trace_from(traced, b->covered, b->x, b->y, b->depth, view);
  for (uint left = mask_bits(b->covered); left != 0;) {
    const uint one = ((const uint*)&b->triangle)[lowest_bit(left)];
    const mask_t here = b->triangle == (uint16)(one);
    left &= ~mask_bits(here);
    trace_from_triangle(traced, one, scene->triangle_instance, here);
  }
}
#endif

kernel ONE_ITEM void resolve_edges(TRACED_ARGUMENTS global const uint* triangles, global const float* depths,
                                   global const ushort* edges, OUTPUT_ARGUMENTS RESOLVE_ARGUMENTS) {
  ASSUME_ONE_ITEM;
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const Output output = GIVEN_OUTPUT;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, tile_y * view->tiles_x + tile_x, view);
  LIGHT_EDGES
  EdgeSurfaces e;
  EdgeBatch b;
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      find_edge_surfaces(&e, &scene, triangles, depths, edges, x0, y0, width, height);
      for (uint i = 0; i < e.count; i += 16) {
        take_batch(&b, &e, i, &scene);
#ifdef SHADOWS_TRACED
        trace_from_batch(&traced, &b, &scene, view);
#endif
        const Where where = {&e, &b, i};
        const Resolved r = {&b.attributes, &b.material, b.x, b.y, b.depth, b.covered};
        store_resolved(&output, &r, &where, &scene, &lights, view);
        if (SHOWS_LIGHT(output)) keep_light(&e, &b, light_of(&output, &r, &where, &lights, bin_edges, view));
      }
      if (SHOWS_LIGHT(output)) show_edges(&e, output.background, output.image, &lights, view);
    }
  }
}
