// Radiance of resolved surfaces: what they show of themselves, directional lights, then point and spot
// lights, in the order of forward's shader (shaders/forward.frag).
//
// -DDIRECTIONAL  there are directional lights
// -DDIRECTIONAL_SHADOWS  some of them casts a shadow
// -DEFFECT_NAME  the effect of src/engine/effects/NAME.cpp adds light or takes it away
// (shared/effects/NAME.h) -DSLICES       tiles are cut into depth slices: a pixel takes the list of the cell
// that its depth lies in -DLIGHTS_VOXELS  point and spot lights come from a voxel light buffer
//                  (kernels/voxels/voxel_lookup.h), not from lists
// -DVOXEL_EXACT  of a list, as many lights a pixel are shaded by themselves, those that matter most, and only
//                the rest comes from the volume
// -DWORLD_GRID   lists are those of the world grid: a pixel takes that of the cell around its position
// -DLIST_FACTORS, -DSHADOWS, -DINDEX_32, -DZ_BINS, -DSPOTS, -DBLINN, -DLAMBERT, -DCLEARCOAT, -DSPECULAR,
// -DSKIN, -DMINNAERT
//                as kernels/resolve/shade_pixels.h says
#pragma once

#include "kernels/resolve/resolve.h"
#include "kernels/resolve/shade_pixels.h"
#include "shared/effects.h"
#include "shared/light_grid.h"
#include "shared/volume_place.h"
#ifdef LIGHTS_VOXELS
#include "kernels/voxels/voxel_lookup.h"
#ifdef VOXEL_EXACT
#include "shared/voxel_exact.h"
#endif
#define SOURCE_LIST(X)                        \
  X(global const stored_voxel_t*, irradiance) \
  X(global const stored_voxel_t*, directions) \
  X(constant VoxelLookup*, voxels)
#elif defined(WORLD_GRID)
#include "shared/world_grid.h"
#define SOURCE_LIST(X)                 \
  X(global const uint*, world_buckets) \
  X(global const uint2*, world_keys)   \
  X(constant WorldGridParams*, world)  \
  X(constant WorldViewParams*, world_view)
#else
#define SOURCE_LIST(X)
#endif

// Arguments of all kernels that resolve triangles, and the values of ResolveScene and ResolveLights. In
// order: the records of a triangle number (raster/raster_view.h); surfaces, vertices and materials
// (shared/surface_records.h); chains of texels (renderer/upload/texel_chain.h); lights (shared/light_table.h),
// directional ones two float4 each; the inputs of effects (shared/effects.h); the light grid
// (shared/light_grid.h), or null for every light at every pixel: the same sum, since a list leaves out only
// zeros; with -DZ_BINS z-bins of each light; the data of another source of lights (voxels, the world grid:
// shared/world_grid.h); with -DZ_BINS the depth keys between z-bins; with -DSLICES those between slices.
#define RESOLVE_ARGUMENTS                                                                             \
  RESOLVE_SCENE_LIST(PARAMETER)                                                                       \
  LIGHT_ARGUMENTS global const float4 *directional,                                                   \
      BASE_EFFECTS(EFFECT_PARAMETERS) global const uint2 *cells, global const index_t *light_indices, \
      global const uint *light_bins, FACTOR_ARGUMENTS SOURCE_LIST(PARAMETER)                          \
  constant float *bin_edges, constant float *slice_edges, constant ViewParams *view
#ifdef HAS_SURFACE_VALUES
#define GIVEN_SURFACE_VALUES .values = GIVEN_SURFACE_ARRAYS,
#else
#define GIVEN_SURFACE_VALUES
#endif
#define RESOLVE_SCENE                                                                                \
  {                                                                                                  \
    RESOLVE_SCENE_LIST(GIVEN)                                                                        \
    GIVEN_SURFACE_VALUES.half_size = (float2)(0.5f * (float)view->width, 0.5f * (float)view->height) \
  }
// clang-format on
#define RESOLVE_LIGHTS                                                                             \
  {                                                                                                \
    .lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(light_indices) GIVEN_SHADOWS},                \
    .directional = directional, .list = light_indices, .cells = cells, .slice_edges = slice_edges, \
    SOURCE_LIST(GIVEN) BASE_EFFECTS(EFFECT_VALUES)                                                 \
  }

typedef struct ResolveLights {
  Lights lights;
  global const float4* directional;  // two each: direction to the light, and illuminance
  BASE_EFFECTS(EFFECT_MEMBERS)
  global const index_t* list;  // null: all of them; with -DSLICES and -DWORLD_GRID where all lists begin
  uint count;
  global const uint2* cells;  // with -DSLICES: of all tiles
  uint cell;                  // the tile's in slice 0
  constant float* slice_edges;
  SOURCE_LIST(MEMBER)
} ResolveLights;

// The list of a tile's cell, or the cells that are one behind the other.
static inline void take_list(ResolveLights* l, global const index_t* light_indices, global const uint2* cells,
                             uint cell, constant ViewParams* view) {
#ifdef WORLD_GRID
  l->list = light_indices;
#elif defined(SLICES)
  l->list = light_indices;
  l->cell = cell;
#else
  l->list = cells ? light_indices + cells[cell].x : 0;
  l->count = cells ? cells[cell].y : view->light_count;
#endif
}

#ifdef SLICES
// From the nearest slice to the farthest, the list of each for the pixels in it.
static inline Real3 light_of_cells(Real3 own, const ShadingPoint* p, real depth, mask_t lit,
                                   const ResolveLights* l, constant float* bin_edges,
                                   constant ViewParams* view) {
  const real nearest = lit ? -depth : REAL(INFINITY), farthest = lit ? depth : REAL(INFINITY);
  const uint first = slice_of_key(min_lane(nearest), l->slice_edges);
  const uint last = slice_of_key(-min_lane(farthest), l->slice_edges);
  Real3 sum = own;
  for (uint slice = first; slice <= last; ++slice) {
    const float begin = slice == 0 ? -INFINITY : l->slice_edges[slice - 1], end = l->slice_edges[slice];
    const mask_t here = lit & (-depth >= REAL(begin)) & (-depth < REAL(end));
    if (!any_lane(here)) continue;
    const uint2 range = l->cells[cell_in_slice(l->cell, slice, view->tiles_x, view->tiles_y)];
    const PixelBins bins = bins_of_pixels(depth, here, bin_edges);
    sum = select3(here, sum_of_list(own, p, here, l->list + range.x, range.y, bins, &l->lights), sum);
  }
  return sum;
}
#endif

#ifdef VOXEL_EXACT
static inline real importance_at(const ShadingPoint* p, mask_t lit, PunctualLight light) {
  return lit ? voxel_importance(arrival_at(p->position, light), light) : REAL(0.0f);
}

// Shades the lights of the list that matter most at each pixel, and takes them out of the rest.
static inline Real3 exact_light(Real3 sum, const ShadingPoint* p, mask_t lit, const ResolveLights* l,
                                VoxelLight* rest) {
  real greatest[VOXEL_EXACT];
  for (uint k = 0; k < VOXEL_EXACT; ++k) greatest[k] = 0.0f;
  for (uint i = 0; i < l->count; ++i) {
    const PunctualLight light = light_at(&l->lights, l->list ? l->list[i] : i);
    if (!any_lane(lit & in_range(p->position, light))) continue;
    real value = importance_at(p, lit, light);
    for (uint k = 0; k < VOXEL_EXACT; ++k) {
      const real larger = lane_max(greatest[k], value);
      value = lane_min(greatest[k], value);
      greatest[k] = larger;
    }
  }
  for (uint i = 0; i < l->count; ++i) {
    const PunctualLight light = light_at(&l->lights, l->list ? l->list[i] : i);
    if (!any_lane(lit & in_range(p->position, light))) continue;
    const real value = importance_at(p, lit, light);
    const mask_t chosen = (value > REAL(0.0f)) & (value >= greatest[VOXEL_EXACT - 1]);
    if (!any_lane(chosen)) continue;
    sum = add3(sum, select3(chosen, radiance_from(*p, light), real3(REAL(0.0f), REAL(0.0f), REAL(0.0f))));
    *rest = without_light(*rest, p->position, light, chosen ? REAL(1.0f) : REAL(0.0f), l->voxels);
  }
  *rest = at_least_nothing(*rest);
  return sum;
}
#endif

#ifdef WORLD_GRID
// A cell's list and the lights of every list, merged: the order of the brute-force loop.
static inline Real3 sum_of_world_lists(Real3 sum, const ShadingPoint* p, mask_t lit, uint2 range,
                                       const ResolveLights* l) {
  uint i = range.x, other = l->world->everywhere_first;
  const uint end = i + range.y, other_end = other + l->world->everywhere_count;
  while (i < end || other < other_end) {
    const uint light = i < end ? l->list[i] : UINT_MAX,
               everywhere = other < other_end ? l->list[other] : UINT_MAX;
    if (light < everywhere) {
      ++i;
    } else {
      ++other;
    }
    sum = with_light(sum, p, lit, min(light, everywhere), 1.0f, &l->lights);
  }
  return sum;
}

// The pixels' cells one after the other, each with its list. Neighbours are mostly in one cell.
static inline Real3 light_of_world(Real3 own, const ShadingPoint* p, mask_t lit, const ResolveLights* l) {
  constant WorldGridParams* const world = l->world;
  const WorldLists lists = {.buckets = l->world_buckets, .keys = l->world_keys, .cells = l->cells};
  const Real3 at = world_position(p->position, l->world_view);
  const whole x = world_coordinate(at.x, world->min_x, world->max_x);
  const whole y = world_coordinate(at.y, world->min_y, world->max_y);
  const whole z = world_coordinate(at.z, world->min_z, world->max_z);
#if LANES == 16
  whole list = 0, count = 0;
  uint2 ranges[LANES];
  uint found = 0;
  for (uint left = mask_bits(lit); left != 0; ++found) {
    const uint one = lowest_bit(left);
    const int cell_x = ((const int*)&x)[one], cell_y = ((const int*)&y)[one], cell_z = ((const int*)&z)[one];
    const mask_t here = lit & (x == (whole)(cell_x)) & (y == (whole)(cell_y)) & (z == (whole)(cell_z));
    left &= ~mask_bits(here);
    ranges[found] = world_range((uint)cell_x, (uint)cell_y, (uint)cell_z, world, &lists);
    list = here ? (whole)((int)ranges[found].x) : list;
    count = here ? (whole)((int)ranges[found].y) : count;
  }
  Real3 sum = own;
  mask_t left = lit;
  for (uint i = 0; i < found; ++i) {
    // Small cells without lights of their own share a larger one's list.
    const mask_t here = left & (list == (whole)((int)ranges[i].x)) & (count == (whole)((int)ranges[i].y));
    if (!any_lane(here)) continue;
    left &= ~here;
    sum = select3(here, sum_of_world_lists(own, p, here, ranges[i], l), sum);
  }
  return sum;
#else
  return sum_of_world_lists(own, p, lit, world_range((uint)x, (uint)y, (uint)z, world, &lists), l);
#endif
}
#endif

#define INPUT_OF_LIGHTS(kind, type, name, resource) , l->name
#define VALUE_OF_POINT(kind, type, name, resource) , p->surface.name
#define ADD_BASE(inputs, base, own) \
  sum = add3(sum, base(*p, s->occlusion, r->covered inputs(INPUT_OF_LIGHTS) own(VALUE_OF_POINT)));

// p: resolved_point(r).
static inline Real3 own_light(const ShadingPoint* p, const Resolved* r, const ResolveLights* l,
                              constant ViewParams* view) {
  const Surface* s = r->surface;
  const Real3 ambient =
      reflected_ambient(*p, REAL(view->ambient_r), REAL(view->ambient_g), REAL(view->ambient_b));
  Real3 sum = add3(UNDER_COAT(*p, s->emissive), scale3(ambient, s->occlusion));
#ifdef DIRECTIONAL
  for (uint i = 0; i < view->directional_count; ++i) {
    const float4 to_light = l->directional[2 * i], light = l->directional[2 * i + 1];
    Real3 back = reflected(*p, real3(REAL(to_light.x), REAL(to_light.y), REAL(to_light.z)));
#ifdef MET_BY_EFFECTS
    back = scale3(
        back, effects_meet(&l->lights.reach, view->light_count + i, p->surface) ? REAL(1.0f) : REAL(0.0f));
#endif
#ifdef DIRECTIONAL_SHADOWS
    back = scale3(back, seen_share(&l->lights.shadows, view->light_count + i));
#endif
#ifdef REACHED_BY_EFFECTS
    back = scale3(back,
                  effects_reach(&l->lights.reach, view->light_count + i, p->position,
                                real3(REAL(to_light.x), REAL(to_light.y), REAL(to_light.z)), VALUES_AT(*p)));
#endif
#ifdef TINTED_BY_EFFECTS
    const Real3 tint =
        effects_tint(&l->lights.reach, view->light_count + i, p->position,
                     real3(REAL(to_light.x), REAL(to_light.y), REAL(to_light.z)), VALUES_AT(*p));
    back = real3(back.x * tint.x, back.y * tint.y, back.z * tint.z);
#endif
    sum = add3(sum, real3(back.x * light.x, back.y * light.y, back.z * light.z));
  }
#endif
  BASE_EFFECTS(ADD_BASE)
  return sum;
}

#ifdef BACKGROUND_OF_EFFECTS
#define SEE_BACKGROUND(inputs, background, own) seen = background(direction inputs(INPUT_OF_LIGHTS));

// What pixels without a surface show. (x, y): their middles.
static inline Real3 background_at(real x, real y, const ResolveLights* l, constant ViewParams* view) {
  const Real3 to_viewer = direction_to_viewer(position_of_pixel(x, y, REAL(1.0f), view));
  const Real3 direction = scale3(to_viewer, REAL(-1.0f));
  Real3 seen = direction;
  BACKGROUND_EFFECTS(SEE_BACKGROUND)
  return seen;
}

// Of one pixel.
static inline float4 background_of(float4 background, uint pixel, const ResolveLights* l,
                                   constant ViewParams* view) {
  const real x = REAL((float)(pixel % view->width) + 0.5f), y = REAL((float)(pixel / view->width) + 0.5f);
  const Real3 seen = background_at(x, y, l, view);
  return (float4)(LANE(seen.x, 0), LANE(seen.y, 0), LANE(seen.z, 0), 1.0f);
}
#else
#define background_of(background, pixel, lights, view) (background)
#endif

// The colour that an unlit surface shows in place of light.
static inline Real3 unlit_or(const Surface* s, Real3 light) {
  return select3(s->unlit, s->base_color, light);
}

// A blended surface of this alpha over what is behind it, which may be infinite.
static inline float4 blended(float4 over, float alpha, float4 under) {
  const float4 most = LARGEST_BLENDED, behind = alpha < 1.0f ? under * (1.0f - alpha) : (float4)(0.0f);
  return (over > most ? most : over) * alpha + behind;
}

static inline ShadingPoint resolved_point(const Resolved* r, constant ViewParams* view) {
  const Attributes* a = r->attributes;
  const Surface* s = r->surface;
  const Real3 position = position_of_pixel(r->x, r->y, r->covered ? r->depth : REAL(1.0f), view);
  const Real3 to_viewer = direction_to_viewer(position);
  ShadingPoint p =
      shading_point(position, to_viewer, shading_normal(a, s), s->base_color, s->metallic, s->roughness);
#ifdef HAS_SURFACE_VALUES
  p.surface = a->values;
#endif
#ifdef SPECULAR
  p = with_specular(p, s->metallic, s->f0, s->f90);
#endif
#ifdef SKIN
  p = with_skin(p, s->subsurface, s->roll_off);
#endif
#ifdef MINNAERT
  p = with_minnaert(p, to_viewer, s->minnaert_k);
#endif
#ifdef CLEARCOAT
  p = with_coat(p, coat_normal(a, s), s->coat, s->coat_roughness);
#endif
  return p;
}

static inline Real3 radiance(const Resolved* r, const ResolveLights* l, constant float* bin_edges,
                             constant ViewParams* view) {
  const mask_t lit = r->covered;
  const ShadingPoint p = resolved_point(r, view);
  Real3 sum = own_light(&p, r, l, view);
#ifdef LIGHTS_VOXELS
  VoxelLight of_voxels = voxel_light_at(p.position, lit, l->irradiance, l->directions, l->voxels);
#ifdef VOXEL_EXACT
  sum = exact_light(sum, &p, lit, l, &of_voxels);
#endif
  sum = add3(sum, radiance_of_voxels(p, of_voxels));
#elif defined(WORLD_GRID)
  sum = light_of_world(sum, &p, lit, l);
#elif defined(SLICES)
  sum = light_of_cells(sum, &p, r->depth, lit, l, bin_edges, view);
#else
  sum = sum_of_list(sum, &p, lit, l->list, l->count, bins_of_pixels(r->depth, lit, bin_edges), &l->lights);
#endif
  return unlit_or(r->surface, sum);
}
