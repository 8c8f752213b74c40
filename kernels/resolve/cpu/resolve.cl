// Resolves the surface of every pixel of a visibility buffer and passes it to an output
// (kernels/resolve/output.h), for CPUs: a work-item takes a tile, block after block of 4 x 4 pixels
// (kernels/resolve/resolve_block.h). Burns, Hunt, "The Visibility Buffer" (JCGT 2013).
//
// triangles, depths  per pixel, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h
// OUTPUT_ARGUMENTS   kernels/resolve/output.h
// -DTILE      pixels a side, a multiple of 8 (default 16)
// -DOUTPUT_…, -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/texel_places.h"

typedef struct Where {
  global const uint* triangles;
  uint x, y, width, height;
} Where;

static inline TexelPlaces texel_places(const Where* w) {
  return texels_of_block(w->x, w->y, w->width, w->height);
}

static inline real seen_samples(const Where* w, uint* most) {
  *most = popcount(PIXEL_SAMPLES);
  return REAL((float)popcount(PIXEL_SAMPLES));
}

static inline void places_of_samples(size_t* at, const Where* w, uint k) {
  for (uint i = 0; i < 16; ++i) {
    const uint x = min(w->x + i % 4, w->width - 1), y = min(w->y + i / 4, w->height - 1);
    at[i] = ((size_t)y * w->width + x) * SAMPLES + k;
  }
}

#include "kernels/resolve/output.h"

kernel ONE_ITEM void resolve(global const uint* triangles, global const float* depths,
                             OUTPUT_ARGUMENTS RESOLVE_ARGUMENTS) {
  ASSUME_ONE_ITEM;
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const Output output = GIVEN_OUTPUT;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, tile_y * view->tiles_x + tile_x, view);
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      const Where where = {triangles, x, y, width, height};
      Real3 color = real3(REAL(output.background.x), REAL(output.background.y), REAL(output.background.z));
#ifdef BACKGROUND_OF_EFFECTS
      if (SHOWS_LIGHT(output) && any_lane(~covered))
        color = background_at((float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, &lights, view);
#endif
      if (NEEDS_EVERY_PIXEL || any_lane(covered)) {
        const Attributes* a = block_attributes(&walk, covered, x, y);
        Surface s = {0};
        add_materials(&s, a, &scene, covered);
        real depth = REAL(0.0f);
        if (READS_DEPTH(output)) depth = block_depths(&walk, depths, x, y);
        const Resolved r = resolved_at(a, &s, x, y, depth, covered);
        store_resolved(&output, &r, &where, &scene, &lights, view);
        if (SHOWS_LIGHT(output)) {
          light_pixels(&lights.lights, x, y, view);
          const Real3 shown = light_of(&output, &r, &where, &lights, bin_edges, view);
          color = select3(covered, shown, color);
        }
      }
      if (SHOWS_LIGHT(output)) store_block(output.image, color, REAL(1.0f), x, y, width, height);
    }
  }
}
