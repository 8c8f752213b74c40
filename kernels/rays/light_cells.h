// Shadow rays answered from a light's cells in place of the tree: Haines and Greenberg, "The Light Buffer: A
// Shadow-Testing Accelerator" (IEEE CG&A 1986), made exact. The same answers to the bit, since a cell lists
// whatever its rays can meet, and the tests are those of rays/rays.h.
#pragma once

#include "kernels/rays/rays.h"
#include "shared/light_cells.h"

#define LIGHT_CELL_ARGUMENTS                                                      \
  global const LightCellTable *light_cells, global const uint *light_cell_starts, \
      global const LightCellEntry *light_cell_entries, global const LightCellTriangle *light_cell_triangles
#define LIGHT_CELLS \
  { light_cells, light_cell_starts, light_cell_entries, light_cell_triangles }

typedef struct LightCells {
  global const LightCellTable* tables;  // a light each
  global const uint* starts;            // of a cell's entries; the next cell's is their end
  global const LightCellEntry* entries;
  global const LightCellTriangle* triangles;
} LightCells;

// Points relative to a point light, or for a directional light to the rays' origin; the share of the way to
// them at which rays end; and the rays' lengths.
typedef struct CellRays {
  Real3 to;
  real end, length;
} CellRays;

// Each lane's cell in the cube of a point light: an index of the light's starts.
static inline whole cell_of_cube(Real3 to, uint size) {
  const real ax = fabs(to.x), ay = fabs(to.y), az = fabs(to.z);
  const mask_t is_x = ax >= lane_max(ay, az), is_y = ~is_x & (ay >= az);
  const real along = is_x ? to.x : is_y ? to.y : to.z, u = is_x ? to.y : to.x, v = is_x | is_y ? to.z : to.y;
  const real scale = 0.5f * (float)size / fabs(along), half_size = REAL(0.5f * (float)size),
             last = REAL((float)size - 1.0f);
  const whole x = TO_WHOLE(lane_min(lane_max(fma(u, scale, half_size), REAL(0.0f)), last)),
              y = TO_WHOLE(lane_min(lane_max(fma(v, scale, half_size), REAL(0.0f)), last));
  const whole face = (is_x   ? (whole)(0)
                      : is_y ? (whole)(2)
                             : (whole)(4)) +
                     (along < 0.0f ? (whole)(1) : (whole)(0));
  return face * (int)(size * size + 1) + y * (int)size + x;
}

static inline whole cell_of_grid(Real3 to, uint size, global const LightCellGrid* g) {
  const real last = REAL((float)size - 1.0f), x = ray_side(to, g->u[0], g->u[1], g->u[2], g->u[3]),
             y = ray_side(to, g->v[0], g->v[1], g->v[2], g->v[3]);
  return TO_WHOLE(lane_min(lane_max(y, REAL(0.0f)), last)) * (int)size +
         TO_WHOLE(lane_min(lane_max(x, REAL(0.0f)), last));
}

// As meets_triangle of rays/ray_packet.h, with stored planes.
#if LANES == 1
static inline mask_t meets_seen(global const LightCellTriangle* t, const CellRays* rays, const bool point) {
  global const float4* planes = (global const float4*)t;
  const float4 n = planes[0];
  const float past = fma(rays->end, ray_side(rays->to, n.x, n.y, n.z, 0.0f), n.w);
  const float4 a = planes[1], b = planes[2], c = planes[3];
  const float u = ray_side(rays->to, a.x, a.y, a.z, point ? 0.0f : a.w),
              v = ray_side(rays->to, b.x, b.y, b.z, point ? 0.0f : b.w),
              w = ray_side(rays->to, c.x, c.y, c.z, point ? 0.0f : c.w);
  return lane_min(lane_min(u, v), lane_min(w, lane_min(past, rays->end))) >= 0.0f;
}
#else
static inline real edge_side(Real3 at, global const float edge[4], const bool point) {
  return ray_side(at, edge[0], edge[1], edge[2], point ? 0.0f : edge[3]);
}

static inline __attribute__((always_inline)) mask_t meets_seen(global const LightCellTriangle* t,
                                                               const CellRays* rays, const bool point) {
  const real past =
      fma(rays->end, ray_side(rays->to, t->normal[0], t->normal[1], t->normal[2], 0.0f), REAL(t->normal[3]));
  const real u = edge_side(rays->to, t->edge_0, point), v = edge_side(rays->to, t->edge_1, point),
             w = edge_side(rays->to, t->edge_2, point);
  return lane_min(lane_min(u, v), lane_min(w, lane_min(past, rays->end))) >= 0.0f;
}
#endif

// Returns the lanes that meet the triangle and are hidden by it. A blended triangle adds to their *veil
// instead.
RAYS_CALL uint hidden_by_met(const RayScene* scene, RaySource light, Real3 to, real gap, whole own, int place,
                             uint met, whole* veil) {
  RayPacket p;
  set_packet(&p, light, to, gap);
#ifdef RAYS_VEILS
  p.veil = *veil;
#endif
  const RayOctants octants = octants_of(&p);
  uint hidden = 0;
  while (met != 0) {  // mostly once
    const uint live = take_octant(&p, &octants, met);
    met &= ~live;
    hidden |= lane_bits(ray_hides(scene, &p, place, own, lanes_of(live)));
  }
#ifdef RAYS_VEILS
  *veil = p.veil;
#endif
  return hidden;
}

// The rays of set_packet in rays/ray_packet.h. *squared: their squared lengths, or for a directional light
// the squared distances of their points from the origin.
static inline __attribute__((always_inline)) CellRays cell_rays(global const LightCellTable* table,
                                                                RaySource light, Real3 to, real gap,
                                                                const bool point, real* squared) {
  CellRays rays;
  if (point) {
    rays.to = real3(from_double(to.x, light.x), from_double(to.y, light.y), from_double(to.z, light.z));
  } else {
    rays.to = real3(fma(gap, REAL((float)light.x), to.x), fma(gap, REAL((float)light.y), to.y),
                    fma(gap, REAL((float)light.z), to.z));
  }
  *squared = fma(rays.to.z, rays.to.z, fma(rays.to.y, rays.to.y, rays.to.x * rays.to.x));
  if (point) {
    rays.length = sqrt(*squared);
    rays.end = 1.0f - gap / rays.length;
  } else {
    global const float* d = table->grid.toward;
    rays.length = table->grid.top - ray_side(rays.to, d[0], d[1], d[2], 0.0f);
    rays.end = REAL(1.0f);
  }
  return rays;
}

// Lanes of `active` that lists serve.
static inline uint served_lanes(global const LightCellTable* table, const CellRays* rays, real squared,
                                uint active, const bool point) {
  mask_t served = squared <= REAL(table->squared);
  global const float* axis = table->grid.toward;
  if (point && table->grid.top >= -1.0f)
    served &= ray_side(rays->to, axis[0], axis[1], axis[2], 0.0f) >= table->grid.top * rays->length;
  return active & lane_bits(served);
}

#if LANES == 1
static inline uint2 entry_of(const LightCells* cells, uint number) {
  return ((global const uint2*)cells->entries)[number];
}

// The first triangle of the entries from *i to `end` that the ray meets; *i is then its entry, or `end` if
// there is none. Neighbours find theirs together, and together ask whether they hide them. *next: entry *i,
// which is read while the entry before it is tested.
static inline uint first_met(const LightCells* cells, const CellRays* rays, uint* i, uint end, uint2* next,
                             const bool point) {
  for (; *i < end; ++*i) {
    const uint2 entry = *next;
    if (*i + 1 < end) *next = entry_of(cells, *i + 1);
    if (!(rays->length >= as_float(entry.y))) break;
    if (meets_seen(cells->triangles + entry.x, rays, point)) return entry.x;
  }
  *i = end;
  return 0;
}
#endif

static inline __attribute__((always_inline)) uint hidden_by_lists(
    const LightCells* cells, const RayScene* scene, global const LightCellTable* table, RaySource light,
    Real3 to, real gap, uint active, whole own, uint* served, whole* veil, const bool point) {
  real squared;
  const CellRays rays = cell_rays(table, light, to, gap, point, &squared);
  const whole cell =
      point ? cell_of_cube(rays.to, table->size) : cell_of_grid(rays.to, table->size, &table->grid);
  *served = served_lanes(table, &rays, squared, active, point);
#if LANES == 1
  global const uint* starts = cells->starts + table->first_start + cell;
  uint i = *served != 0 ? starts[0] : 0;
  const uint end = *served != 0 ? starts[1] : 0;
  uint2 next = i < end ? entry_of(cells, i) : (uint2)(0);
  for (;; ++i) {
    const uint triangle = first_met(cells, &rays, &i, end, &next, point);
    if (i == end) return 0;
    const int place =
        point ? as_int(cells->triangles[triangle].edge_0[3]) : (int)(triangle - table->first_triangle);
    if (hidden_by_met(scene, light, to, gap, own, place, 1, veil)) return 1;
  }
#else
  uint hidden = 0;
  for (uint left = *served; left != 0;) {
    const int one = ((const int*)&cell)[lowest_bit(left)];
    uint here = left & lane_bits(cell == (whole)(one));
    left &= ~here;
    global const uint* starts = cells->starts + table->first_start + one;
    for (uint i = starts[0], end = starts[1]; i < end && here != 0; ++i) {
      const LightCellEntry entry = cells->entries[i];
      if ((lane_bits(rays.length >= entry.near) & here) == 0) break;
      global const LightCellTriangle* t = cells->triangles + entry.triangle;
      const uint met = here & lane_bits(meets_seen(t, &rays, point));
      if (met == 0) continue;
      const int place = point ? as_int(t->edge_0[3]) : (int)(entry.triangle - table->first_triangle);
      const uint hides = hidden_by_met(scene, light, to, gap, own, place, met, veil);
      hidden |= hides;
      here &= ~hides;
    }
  }
  return hidden;
#endif
}

// As rays_veiled, for a light with lists. *served: lanes that are answered; longer rays are not.
static inline uint hidden_by_cells(const LightCells* cells, const RayScene* scene,
                                   global const LightCellTable* table, RaySource light, Real3 to, real gap,
                                   uint active, whole own, uint* served, whole* veil) {
  return light.w != 0
             ? hidden_by_lists(cells, scene, table, light, to, gap, active, own, served, veil, true)
             : hidden_by_lists(cells, scene, table, light, to, gap, active, own, served, veil, false);
}

// As rays_share: rays that the light's lists do not serve take the tree. number: of the light.
static inline whole cells_share(const LightCells* cells, const RayScene* scene, uint number, RaySource light,
                                Real3 to, real gap, mask_t active, whole own, int* last_blocker) {
  global const LightCellTable* table = cells->tables + number;
  const uint asked = lane_bits(active);
  uint served = 0, hidden = 0;
  whole veil = (whole)(0);
  if (table->size != 0)
    hidden = hidden_by_cells(cells, scene, table, light, to, gap, asked, own, &served, &veil);
  const whole share = hidden_255ths(lanes_of(hidden), veil);
  if (served == asked) return share;
  const mask_t left = active & ~lanes_of(served);
  return left ? rays_share(scene, light, to, gap, left, own, last_blocker) : share;
}
