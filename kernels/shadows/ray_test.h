// How a light's shadow is found at LANES pixels by a ray each: from the light's cells if it has some, else by
// the tree.
//
// -DSHADOW_CELLS   lights may have light cells
// -DSHADOW_MASKS  with -DSHADOW_PICK: lights and surfaces have masks
#pragma once

#include "kernels/shadows/receivers.h"

#ifdef SHADOW_CELLS
#include "kernels/rays/light_cells.h"
#define CELL_ARGUMENTS LIGHT_CELL_ARGUMENTS,
#define GIVEN_CELLS .cells = LIGHT_CELLS,
#else
#define CELL_ARGUMENTS
#define GIVEN_CELLS
#endif
// triangle_masks  masks of each triangle's surface, by the rays' numbers
#ifdef SHADOW_MASKS
#define MASK_ARGUMENTS global const uint *triangle_masks,
#define GIVEN_MASKS .triangle_masks = triangle_masks,
#else
#define MASK_ARGUMENTS
#define GIVEN_MASKS
#endif
#define SHADOW_TEST_ARGUMENTS MASK_ARGUMENTS CELL_ARGUMENTS
#define SHADOW_TEST \
  { GIVEN_MASKS GIVEN_CELLS.last_blocker = -1 }

typedef struct ShadowTest {
  uint traced;
  int last_blocker;
  global const uint* triangle_masks;  // null: all lights shine on all surfaces
#ifdef SHADOW_CELLS
  LightCells cells;
#endif
#ifdef SHADOW_PICK
  whole picked[LANES];  // of each block of a tile: 255ths of its lights together
#endif
} ShadowTest;

static inline whole hidden_by_test(ShadowTest* rays, const RayScene* scene, const Receivers* r, uint light,
                                   global const ShadowLight* l, mask_t active) {
  const RaySource source = {l->x, l->y, l->z, l->w};
  rays->traced += popcount(lane_bits(active));
#ifdef SHADOW_CELLS
  return cells_share(&rays->cells, scene, light, source, r->at, r->gap, active, r->own, &rays->last_blocker);
#else
  return rays_share(scene, source, r->at, r->gap, active, r->own, &rays->last_blocker);
#endif
}

#define rays_of_test(test) ((test)->traced)
