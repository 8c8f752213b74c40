// How a light's shadow is found at LANES pixels: a ray each, with -DSHADOW_RAYS many to its sphere, with
// -DSHADOW_PICK some for all lights together, or with -DSHADOW_MAP the texels of its map.
//
// -DSHADOW_GROUPS  with -DSHADOW_PICK: lights and surfaces have light groups
// -DSHADOW_BYTES  of a light a share may be hidden (shared/shadow_bits.h)
// -DSHADOW_CELLS  lights may have light cells, which answer rays in place of the tree
#pragma once

#include "kernels/common/hash.h"  // here, since what is included below under a condition counts as there
#include "kernels/shadows/receivers.h"

#ifdef SHADOW_MAP
#define SHADOW_TEST_ARGUMENTS SHADOW_MAPS_ARGUMENTS,
#define SHADOW_TEST SHADOW_MAPS
typedef ShadowMaps ShadowTest;

// Of its texels around the lanes' points, those that see something nearer, in 255ths of all.
static inline whole hidden_by_test(ShadowTest* maps, const RayScene* scene, const Receivers* r, uint light,
                                   global const ShadowLight* l, mask_t active) {
  const float share = 255.0f / (SHADOW_TAPS * SHADOW_TAPS);
  return TO_WHOLE(TO_REAL(shadow_taps(maps, light, &r->for_maps, active)) * share + 0.5f);
}
#define rays_of_test(test) 0
#else
// triangle_groups  light groups of each triangle's surface, by the rays' numbers
#if defined(SHADOW_PICK) && defined(SHADOW_GROUPS)
#define SHADOW_TEST_ARGUMENTS global const uint *triangle_groups,
#define PICK_GROUPS triangle_groups
#else
#ifdef SHADOW_CELLS
#include "kernels/rays/light_cells.h"
#define SHADOW_TEST_ARGUMENTS LIGHT_CELL_ARGUMENTS,
#else
#define SHADOW_TEST_ARGUMENTS
#endif
#define PICK_GROUPS 0
#endif
#ifdef SHADOW_CELLS
#define SHADOW_TEST \
  { .last_blocker = -1, .cells = LIGHT_CELLS }
#else
#define SHADOW_TEST \
  { .last_blocker = -1 }
#endif
typedef struct ShadowTest {
  uint traced;
  int last_blocker;
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
  global const LightCellTable* table = rays->cells.tables + light;
  if (table->size != 0) {
    const uint asked = lane_bits(active);
    uint served = 0;
    const uint hidden =
        hidden_by_cells(&rays->cells, scene, table, source, r->at, r->gap, asked, r->own, &served);
    const whole share = lanes_of(hidden) ? (whole)(255) : (whole)(0);
    if (served == asked) return share;
    return share |
           rays_share(scene, source, r->at, r->gap, active & ~lanes_of(served), r->own, &rays->last_blocker);
  }
#endif
  return rays_share(scene, source, r->at, r->gap, active, r->own, &rays->last_blocker);
}
#define rays_of_test(test) ((test)->traced)
#if defined(SHADOW_RAYS) || defined(SHADOW_PICK)
#include "kernels/shadows/soft_shadows.h"
#endif
#ifdef SHADOW_PICK
#include "kernels/shadows/picked_shadows.h"
#endif
#endif

// The share of each light that is hidden from the lanes, times 255: 0 or 255 without SHADOW_BYTES. block: of
// the lanes in their tile, 0 for a single one. x, y: the first lane's pixel. Directional lights take one ray
// each.
static inline whole hidden_share(ShadowTest* test, const RayScene* scene, const Receivers* r, uint block,
                                 uint light, global const ShadowLight* lights, constant ShadowView* v, uint x,
                                 uint y) {
  global const ShadowLight* l = lights + light;
#if defined(SHADOW_PICK)
  if (l->w != 0) return picked_or_away(scene, r, l, test->picked[block], v);
#elif defined(SHADOW_RAYS)
  if (l->w != 0) return soft_share(scene, r, l, x, y, light, &test->traced, &test->last_blocker);
#endif
  const mask_t reached = may_shade(r, l);
  if (!any_lane(reached)) return (whole)(0);
  const mask_t away = turned_away(scene, r, l, reached, v);
  const whole hidden = hidden_by_test(test, scene, r, light, l, reached & ~away);
  return away ? (whole)(255) : hidden;
}
