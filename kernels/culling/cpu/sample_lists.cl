// Shortens lists of the light grid to `cap` lights drawn at random, in place, and says how many times each
// light of a list counts, so that the expected sum of any pixel is that of the whole list
// (kernels/culling/sampled_list.h). A work-item takes a cell. Lights stay in the order of their indices.
//
// cells, indices  the light grid
// factors    out, one an index: float bits. Until the end the lights' weights
// cap        at least 1
// seed       of the random numbers (kernels/culling/random_of_cell.h)
// LIGHT_ARGUMENTS  of lights (shared/light_table.h)
// bounds     depth bounds, of `planes` floats a tile (kernels/culling/depth_bounds.h)
// slice_edges  metres, slices + 1 of them
// -DINDEX_32, and what kernels/common/light_columns.h names
#include "kernels/culling/sampled_list.h"

kernel void sample_lists(global uint2* cells, global index_t* indices, uint cell_count, uint cap, uint seed,
                         global uint* factors, LIGHT_ARGUMENTS global const float* bounds, uint planes,
                         global const float* slice_edges, constant CullParams* p) {
  const uint cell = get_global_id(0);
  if (cell >= cell_count) return;
  const uint first = cells[cell].x, count = cells[cell].y;
  global index_t* list = indices + first;
  factors += first;
  if (count <= cap) {
    for (uint i = 0; i < count; ++i) factors[i] = as_uint(1.0f);
    return;
  }
  const LightColumns lights = {GIVEN_LIGHTS};
  const CellCentre middle = cell_centre_of(cell, bounds, planes, slice_edges, p);
  float most = 0.0f;
  for (uint i = 0; i < count; ++i) {
    const float weight = weight_of(light_at(&lights, list[i]), middle);
    factors[i] = as_uint(weight);
    most = fmax(most, weight);
  }
  const float scale = MOST_WEIGHT / most;
  ulong rest = 0;  // the weights of lights that are not certain
  for (uint i = 0; i < count; ++i) {
    const uint weight = whole_weight(as_float(factors[i]), scale);
    factors[i] = weight;
    rest += weight;
  }
  uint slots = cap;  // left for them; never 0, as each other light weighs something
  for (bool more = true; more;) {
    more = false;
    for (uint i = 0; i < count; ++i) {
      const uint weight = factors[i];
      if ((weight & CERTAIN) || (ulong)weight * slots < rest) continue;
      factors[i] = weight | CERTAIN;
      rest -= weight;
      --slots;
      more = true;
    }
  }
  ulong place = first_place(rest, random_of_cell(cell, seed, p));
  uint kept = 0;
  for (uint i = 0; i < count; ++i) {
    const index_t light = list[i];
    const uint weight = factors[i];
    float factor = 1.0f;
    if (!(weight & CERTAIN)) {
      place += (ulong)weight * slots;
      if (place < rest) continue;
      place -= rest;
      factor = factor_of(rest, slots, weight);
    }
    list[kept] = light;
    factors[kept++] = as_uint(factor);
  }
  cells[cell].y = kept;
}
