// Finds the cells that triangles belong to. Triangles are processed LANES at a time, one per lane; with 16
// lanes large ones one after the other, 4 x 4 cells at a time.
#pragma once

#include "kernels/rays/light_cell_triangles.h"

#define LARGE 12.0f      // cells: width plus height of a triangle's box
#define ROW_SLACK 1e-3f  // of a cell: rounding of where a plane leaves a row

#if LANES == 1
// The memory of entries. Each cell's number of entries is counted first, from starts[1] on. Then starts hold where
// cells begin, and each entry moves the start of the next cell.
typedef struct LightCellItems {
  volatile global uint* starts;
  global ulong* entries;  // LightCellEntry each; null: they are counted
  uint first_triangle;
} LightCellItems;

static inline void add_items(LightCellItems* items, uint bits, whole cell, real near, whole number) {
  const uint at = atomic_inc(items->starts + 1 + cell);
  if (items->entries)
    items->entries[at] = (ulong)as_uint(lane_max(near, 0.0f)) << 32 | (items->first_triangle + (uint)number);
}
#else
// Distances rounded down to steps of 1/64 octave from 2^-10 to 2^22 m: the upper bits of a float. Nearer ones
// become 0, farther ones the last step.
#define NEAR_STEPS 2048
#define NEAR_SHIFT 17
#define FIRST_NEAR_STEP ((127 - 10) << 6)

static inline whole near_steps(real near) {
  const whole steps = (bits_of_real(near) >> NEAR_SHIFT) - FIRST_NEAR_STEP;
  return min(max(steps, (whole)(0)), (whole)(NEAR_STEPS - 1));
}

static inline float metres_of_steps(uint steps) {
  return steps == 0 ? 0.0f : as_float((steps + FIRST_NEAR_STEP) << NEAR_SHIFT);
}

// The entries listed so far: a key holds the cell and the distance of a triangle, a number is the triangle's.
typedef struct LightCellItems {
  global uint *keys, *numbers;
  uint count, room;  // beyond `room`, entries are only counted
} LightCellItems;

static inline __attribute__((always_inline)) void add_items(LightCellItems* items, uint bits, whole cell,
                                                            real near, whole number) {
  if (items->count + LANES <= items->room) {
    append_uints(items->keys + items->count, cell * NEAR_STEPS + near_steps(near), bits);
    append_uints(items->numbers + items->count, number, bits);
  }
  items->count += popcount(bits);
}
#endif

// The greatest value of a plane in cell (column, row): column * x + row * y + at.
typedef struct CellPlanes {
  real x, y, at;
} CellPlanes;

// One face of the cube, or the grid, with `size` cells along each side. No ray is longer than `reach`. Cube:
// `along` is the coordinate along the face's axis, `u` and `v` are those across it. Grid: `height` is that of
// its top above its base; for a cube it is 0. `axis` and `cosine`: the axis of a spot's cone and the cosine
// of its angle, below -1 for other lights.
typedef struct CellFace {
  int size, first_cell;
  float reach;
  int along, u, v;
  float sign;
  float height;
  CellPlanes axis;
  float cosine;
} CellFace;

static inline CellPlanes greatest_in_cells(const real plane[3], const CellFace* f) {
  const float h = 2.0f / (float)f->size;
  const real a = plane[f->u], b = plane[f->v], c = plane[f->along] * f->sign;
  const CellPlanes p = {a * h, b * h,
                        c - a - b + (lane_max(a, REAL(0.0f)) + lane_max(b, REAL(0.0f))) * h +
                            PLANE_SLACK * (fabs(a) + fabs(b) + fabs(c)) + 1e-37f};
  return p;
}

static inline CellFace cube_face(global const LightCellJob* job, int number) {
  const int along = number / 2, size = (int)job->size;
  CellFace face = {.size = size,
                   .first_cell = number * (size * size + 1),
                   .reach = job->reach_m,
                   .along = along,
                   .u = along == 0 ? 1 : 0,
                   .v = along == 2 ? 1 : 2,
                   .sign = number % 2 ? -1.0f : 1.0f,
                   .cosine = job->grid.top - CONE_SLACK};
  const real axis[3] = {REAL(job->grid.toward[0]), REAL(job->grid.toward[1]), REAL(job->grid.toward[2])};
  face.axis = greatest_in_cells(axis, &face);
  return face;
}

static inline real plane_in_cells(const CellPlanes* p, real x, real y) {
  return fma(x, p->x, fma(y, p->y, p->at));
}

// The cells from *first to *last in which boxes may be seen along one coordinate.
static inline mask_t cells_of_boxes(real low, real high, real along_low, real along_high, float size,
                                    real* first, real* last) {
  const real nearest = lane_max(along_low, REAL(1e-30f));
  const real from = low / (low < 0.0f ? nearest : along_high),
             to = high / (high > 0.0f ? nearest : along_high);
  const real half_size = REAL(0.5f * size);
  const real begin = fma(from, half_size, half_size) - CELL_SLACK,
             end = fma(to, half_size, half_size) + CELL_SLACK;
  *first = lane_floor(lane_max(begin, REAL(0.0f)));
  *last = lane_floor(lane_min(end, REAL(size - 1.0f)));
  return (begin < size) & (end >= 0.0f);
}

// Returns a bound: no shorter ray into the cell meets the triangle. It is infinite in cells outside of a
// spot's cone. A ray along d reaches the plane at -offset |d| / (normal . d). The bound takes the shortest d
// in the cell and the greatest product, `rising`. In the grid, `rising` is the plane's greatest height above
// the base.
static inline real near_in_cells(const CellFace* f, real x, real y, real offset, real rising, real box_near) {
  if (f->height != 0.0f) return lane_max(f->height - rising, box_near);
  const float h = 2.0f / (float)f->size;
  const real u = lane_max(fabs(fma(x, REAL(h), REAL(0.5f * h - 1.0f))) - 0.5f * h, REAL(0.0f)),
             v = lane_max(fabs(fma(y, REAL(h), REAL(0.5f * h - 1.0f))) - 0.5f * h, REAL(0.0f));
  const real shortest = sqrt(fma(u, u, fma(v, v, REAL(1.0f)))),
             near = lane_max(-offset * 0.999f * shortest / rising, box_near);
  if (f->cosine < -1.0f) return near;
  const real least = f->cosine * (f->cosine > 0.0f ? shortest : REAL(1.7321f));
  return plane_in_cells(&f->axis, x, y) >= least ? near : REAL(INFINITY);
}

// The four planes in a face's cells, and the box's cells.
typedef struct FaceTriangles {
  CellPlanes edges[3], plane;
  real first_x, last_x, first_y, last_y;
} FaceTriangles;

// Narrows *first and *last to the cells of row y that no edge has entirely on its wrong side.
static inline void cells_of_row(const FaceTriangles* t, const real inverse[3], real y, real* first,
                                real* last) {
  for (int e = 0; e < 3; ++e) {
    const real row = fma(y, t->edges[e].y, t->edges[e].at), end = row * inverse[e];
    const mask_t up = t->edges[e].x >= 0.0f;
    *first = up ? lane_max(-end - ROW_SLACK, *first) : *first;
    *last = up ? *last : lane_min(end + ROW_SLACK, *last);
  }
  *first = -lane_floor(-*first);
  *last = lane_floor(*last);
}

static inline __attribute__((always_inline)) void add_small(const CellFace* f, const SeenTriangles* s,
                                                            const FaceTriangles* t, mask_t small,
                                                            whole numbers, LightCellItems* items) {
  real inverse[3];
  for (int e = 0; e < 3; ++e) inverse[e] = 1.0f / fabs(t->edges[e].x);
  for (real y = t->first_y;; y += 1.0f) {
    const mask_t rows = small & (y <= t->last_y);
    if (!any_lane(rows)) return;
    real first = t->first_x, last = t->last_x;
    cells_of_row(t, inverse, y, &first, &last);
    for (real x = first;; x += 1.0f) {
      const mask_t here = rows & (x <= last);
      if (!any_lane(here)) break;
      const real rising = plane_in_cells(&t->plane, x, y),
                 near = near_in_cells(f, x, y, s->offset, rising, s->near);
      const uint bits = lane_bits(here & (rising >= 0.0f) & (near <= f->reach));
      const whole cell =
          f->first_cell + TO_WHOLE(here ? y : REAL(0.0f)) * f->size + TO_WHOLE(here ? x : REAL(0.0f));
      if (bits != 0) add_items(items, bits, cell, near, numbers);
    }
  }
}

#if LANES == 16
#define LANE_OF(x) REAL(((const float*)&(x))[lane])
static inline CellPlanes planes_of_lane(const CellPlanes* p, uint lane) {
  const CellPlanes one = {LANE_OF(p->x), LANE_OF(p->y), LANE_OF(p->at)};
  return one;
}

static inline __attribute__((always_inline)) void add_large(const CellFace* f, const SeenTriangles* s,
                                                            const FaceTriangles* t, uint lane, int number,
                                                            LightCellItems* items) {
  const CellPlanes edge_0 = planes_of_lane(&t->edges[0], lane), edge_1 = planes_of_lane(&t->edges[1], lane),
                   edge_2 = planes_of_lane(&t->edges[2], lane), plane = planes_of_lane(&t->plane, lane);
  const real first_x = LANE_OF(t->first_x), last_x = LANE_OF(t->last_x), first_y = LANE_OF(t->first_y),
             last_y = LANE_OF(t->last_y), offset = LANE_OF(s->offset), box_near = LANE_OF(s->near);
  for (int y0 = (int)first_y.s0 & ~3; y0 <= (int)last_y.s0; y0 += 4) {
    for (int x0 = (int)first_x.s0 & ~3; x0 <= (int)last_x.s0; x0 += 4) {
      const whole column = (LANE_INDEX & 3) + x0, row = (LANE_INDEX >> 2) + y0;
      const real x = TO_REAL(column), y = TO_REAL(row);
      const real rising = plane_in_cells(&plane, x, y);
      const real sides = lane_min(lane_min(plane_in_cells(&edge_0, x, y), plane_in_cells(&edge_1, x, y)),
                                  lane_min(plane_in_cells(&edge_2, x, y), rising));
      const mask_t here = (sides >= 0.0f) & (x >= first_x) & (x <= last_x) & (y >= first_y) & (y <= last_y);
      if (!any_lane(here)) continue;
      const real near = near_in_cells(f, x, y, offset, rising, box_near);
      const uint bits = lane_bits(here & (near <= f->reach));
      if (bits != 0) add_items(items, bits, f->first_cell + row * f->size + column, near, (whole)(number));
    }
  }
}
#endif

// Adds the triangles of the lanes `seen`, under their `numbers`.
static inline __attribute__((always_inline)) void add_to_cells(const CellFace* f, const SeenTriangles* s,
                                                               const FaceTriangles* t, mask_t seen,
                                                               whole numbers, LightCellItems* items) {
#if LANES == 1
  add_small(f, s, t, seen, numbers, items);
#else
  const mask_t large = seen & ((t->last_x - t->first_x) + (t->last_y - t->first_y) > LARGE);
  if (any_lane(seen & ~large)) add_small(f, s, t, seen & ~large, numbers, items);
  for (uint left = lane_bits(large); left != 0; left &= left - 1) {
    const uint lane = lowest_bit(left);
    add_large(f, s, t, lane, ((const int*)&numbers)[lane], items);
  }
#endif
}

static inline __attribute__((always_inline)) void add_to_face(const CellFace* f, const SeenTriangles* s,
                                                              mask_t seen, whole numbers,
                                                              LightCellItems* items) {
  const real along_low = f->sign > 0 ? s->low[f->along] : -s->high[f->along],
             along_high = f->sign > 0 ? s->high[f->along] : -s->low[f->along];
  const real low_u = s->low[f->u], high_u = s->high[f->u], low_v = s->low[f->v], high_v = s->high[f->v];
  const real side = 1.01f * along_high;  // rejects most triangles without a division
  seen &= (along_high > 0.0f) & (low_u <= side) & (-high_u <= side) & (low_v <= side) & (-high_v <= side);
  if (!any_lane(seen)) return;
  FaceTriangles t;
  seen &= cells_of_boxes(low_u, high_u, along_low, along_high, (float)f->size, &t.first_x, &t.last_x);
  seen &= cells_of_boxes(low_v, high_v, along_low, along_high, (float)f->size, &t.first_y, &t.last_y);
  if (!any_lane(seen)) return;
  for (int e = 0; e < 3; ++e) t.edges[e] = greatest_in_cells(s->edges[e], f);
  t.plane = greatest_in_cells(s->normal, f);
  add_to_cells(f, s, &t, seen, numbers, items);
}

// The share of the grid's extent that bounds all rounding: of planes, boxes and a point's place in the grid.
#define GRID_SLACK 0x1p-17f

static inline real along_axis(const real v[3], global const float* axis) {
  return fma(v[2], REAL(axis[2]), fma(v[1], REAL(axis[1]), v[0] * axis[0]));
}

// The greatest value that a plane has in a cell, for points at height 0.
static inline CellPlanes greatest_in_grid(const real plane[3], real offset, global const LightCellJob* job) {
  const real a = along_axis(plane, job->metres_u), b = along_axis(plane, job->metres_v);
  const real rounding = GRID_SLACK * job->extent_m * (fabs(plane[0]) + fabs(plane[1]) + fabs(plane[2]));
  const CellPlanes p = {a, b,
                        offset - a * job->grid.u[3] - b * job->grid.v[3] + lane_max(a, REAL(0.0f)) +
                            lane_max(b, REAL(0.0f)) + CELL_SLACK * (fabs(a) + fabs(b)) + rounding + 1e-37f};
  return p;
}

// The cells along an axis in which boxes are seen.
static inline void cells_across(const SeenTriangles* s, global const float* axis, float pad, float size,
                                real* first, real* last) {
  real at = REAL(axis[3]), spread = REAL(CELL_SLACK);
  for (int k = 0; k < 3; ++k) {
    at = fma(0.5f * (s->low[k] + s->high[k]), REAL(axis[k]), at);
    spread = fma(0.5f * (s->high[k] - s->low[k]) + pad, REAL(fabs(axis[k])), spread);
  }
  *first = lane_floor(lane_min(lane_max(at - spread, REAL(0.0f)), REAL(size - 1.0f)));
  *last = lane_floor(lane_max(lane_min(at + spread, REAL(size - 1.0f)), REAL(0.0f)));
}

// A ray meets a triangle only if it begins below the top of the triangle's box and below its plane. The
// plane's value falls by `down` per metre of height. Planes that are almost parallel to the direction bound
// nothing.
static inline __attribute__((always_inline)) void add_to_grid(global const LightCellJob* job,
                                                              SeenTriangles* s, mask_t seen, whole numbers,
                                                              LightCellItems* items) {
  global const LightCellGrid* g = &job->grid;
  const float extent = job->extent_m, pad = GRID_SLACK * extent;
  const CellFace f = {.size = (int)job->size, .reach = INFINITY, .height = g->top + extent};
  FaceTriangles t;
  cells_across(s, g->u, pad, (float)f.size, &t.first_x, &t.last_x);
  cells_across(s, g->v, pad, (float)f.size, &t.first_y, &t.last_y);
  for (int e = 0; e < 3; ++e) {
    t.edges[e] = greatest_in_grid(s->edges[e], s->edge_offsets[e], job);
    // A plane through an edge along the direction is only rounding, and may face anywhere.
    t.edges[e].at += extent * fabs(along_axis(s->edges[e], g->toward));
  }
  const CellPlanes plane = greatest_in_grid(s->normal, s->offset, job);
  const real down = -along_axis(s->normal, g->toward),
             least = 1e-4f * (fabs(s->normal[0]) + fabs(s->normal[1]) + fabs(s->normal[2]));
  const mask_t steep = down < least;
  t.plane.x = steep ? REAL(0.0f) : plane.x / down;
  t.plane.y = steep ? REAL(0.0f) : plane.y / down;
  t.plane.at = steep ? REAL(f.height) : plane.at / down + extent;
  real top = REAL(pad);
  for (int k = 0; k < 3; ++k) {
    top = fma(0.5f * (s->low[k] + s->high[k]), REAL(g->toward[k]), top);
    top = fma(0.5f * (s->high[k] - s->low[k]) + pad, REAL(fabs(g->toward[k])), top);
  }
  s->near = g->top - top;
  add_to_cells(&f, s, &t, seen, numbers, items);
}
