// The cells of a face that a triangle takes part in, 4 x 4 at a time: counted, or given an entry each.
#pragma once

#include "kernels/rays/cpu/light_cell_builder.h"

// starts[1 + cell]  in and out: the cell's number of entries, or the place of its next one
// entries           out; null: entries are only counted
static inline __attribute__((always_inline)) void add_to_face(const CubeFace* f, uint size,
                                                              global const LightCellTriangle* t,
                                                              const SeenBox* box, uint number, float reach,
                                                              global LightCellEntry* entries) {
  const float along_low = f->sign > 0 ? box->low[f->along] : -box->high[f->along],
              along_high = f->sign > 0 ? box->high[f->along] : -box->low[f->along];
  if (!(along_high > 0.0f)) return;
  int first_x, last_x, first_y, last_y;
  if (!cells_of_box(box->low[f->u], box->high[f->u], along_low, along_high, (float)size, &first_x, &last_x) ||
      !cells_of_box(box->low[f->v], box->high[f->v], along_low, along_high, (float)size, &first_y, &last_y))
    return;
  const float h = 2.0f / (float)size;
  const CellPlane edge_0 = greatest_in_cells(t->edge_0, f, h), edge_1 = greatest_in_cells(t->edge_1, f, h),
                  edge_2 = greatest_in_cells(t->edge_2, f, h), plane = greatest_in_cells(t->normal, f, h);
  for (int y0 = first_y & ~3; y0 <= last_y; y0 += 4) {
    for (int x0 = first_x & ~3; x0 <= last_x; x0 += 4) {
      const whole column = (LANE_INDEX & 3) + x0, row = (LANE_INDEX >> 2) + y0;
      const real x = TO_REAL(column), y = TO_REAL(row);
      const real rising = plane_in_cells(plane, x, y);
      const real sides = lane_min(lane_min(plane_in_cells(edge_0, x, y), plane_in_cells(edge_1, x, y)),
                                  lane_min(plane_in_cells(edge_2, x, y), rising));
      const mask_t in_box = (column >= first_x) & (column <= last_x) & (row >= first_y) & (row <= last_y);
      uint left = mask_bits((sides >= 0.0f) & in_box);
      if (left == 0) continue;
      // A ray along d reaches the plane at -offset |d| / (normal . d): d is taken where it is shortest in the
      // cell, and the product where it is greatest.
      const real u = lane_max(fabs(fma(x, REAL(h), REAL(0.5f * h - 1.0f))) - 0.5f * h, REAL(0.0f)),
                 v = lane_max(fabs(fma(y, REAL(h), REAL(0.5f * h - 1.0f))) - 0.5f * h, REAL(0.0f));
      const real near =
          lane_max(-t->offset * 0.999f * sqrt(fma(u, u, fma(v, v, REAL(1.0f)))) / rising, REAL(box->near));
      left &= mask_bits(near <= reach);
      global uint* counts = f->starts + 1 + y0 * (int)size + x0;
      for (; left != 0; left &= left - 1) {
        const uint lane = lowest_bit(left);
        global uint* count = counts + (lane >> 2) * size + (lane & 3);
        if (entries) {
          const LightCellEntry entry = {number, ((const float*)&near)[lane]};
          entries[*count] = entry;
        }
        ++*count;
      }
    }
  }
}

static inline __attribute__((always_inline)) void add_to_cells(global const LightCellJob* job,
                                                               global uint* starts, const SeenBox* box,
                                                               global const LightCellTriangle* t, uint number,
                                                               global LightCellEntry* entries) {
  for (int number_of_face = 0; number_of_face < 6; ++number_of_face) {
    const CubeFace face = cube_face(starts, job->size, number_of_face);
    add_to_face(&face, job->size, t, box, number, job->reach_m, entries);
  }
}
