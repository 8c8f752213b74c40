// Shortens lists of the light grid to `cap` lights drawn at random, in place, and says how many times each
// light of a list counts, so that the expected sum of any pixel is that of the whole list. A work-item takes
// a cell. Lights stay in the order of their indices.
//
// Systematic sampling with probabilities in proportion to weights (Madow 1949): a light whose share of the
// slots would be one or more is kept for certain and counts once; the others are laid end to end, as long as
// their weights, and one is drawn in each of as many equal steps as slots are left, at the same random place
// in all. Weights are whole numbers from here on, so that the probabilities are exact whatever was rounded
// before.
//
// cells, indices  the light grid
// factors    out, one an index: float bits. Until the end the lights' weights
// cap        at least 1
// seed       of the random numbers (kernels/culling/random_of_cell.h)
// LIGHT_ARGUMENTS  of lights (shared/light_table.h)
// bounds     depth bounds, of `planes` floats a tile (kernels/culling/depth_bounds.h)
// slice_edges  metres, slices + 1 of them
// -DINDEX_32, and what kernels/common/light_columns.h names
#define LANES 1
#include "kernels/common/index_type.h"
#include "kernels/common/light_columns.h"
#include "kernels/culling/random_of_cell.h"

// Beside a weight, which is 2^24 at most: the light is kept for certain.
#define CERTAIN 0x80000000u

// About what a light adds to the cell's surfaces. What the middle does not see of it, past its range or its
// cone, other pixels may: a sixteenth of the light without either counts in any case.
static inline float weight_of(PunctualLight light, Middle m) {
  const float4 at = point_of_middle(-light.position.z, m);
  const Real3 middle = real3(at.x, at.y, -at.z), to_light = offset_to_light(middle, light);
  const float across = m.half_x * at.w, up = m.half_y * at.w, size2 = across * across + up * up;
  const float inverse = 1.0f / (dot3(to_light, to_light) + size2);
  const float light_there = fmin(arrival_at(middle, light).attenuation, inverse) + 0.0625f * inverse;
  const float weight =
      light_there * (0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z);
  return weight > 1e-30f ? fmin(weight, 1e30f) : 1e-30f;
}

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
  const Middle middle = middle_of(cell, bounds, planes, slice_edges, p);
  float most = 0.0f;
  for (uint i = 0; i < count; ++i) {
    const float weight = weight_of(light_at(&lights, list[i]), middle);
    factors[i] = as_uint(weight);
    most = fmax(most, weight);
  }
  const float scale = 16777216.0f / most;
  ulong rest = 0;  // the weights of lights that are not certain
  for (uint i = 0; i < count; ++i) {
    const uint weight = max((uint)(as_float(factors[i]) * scale), 1u);
    factors[i] = weight, rest += weight;
  }
  uint slots = cap;  // left for them; never 0, as each other light weighs something
  for (bool more = true; more;) {
    more = false;
    for (uint i = 0; i < count; ++i) {
      const uint weight = factors[i];
      if ((weight & CERTAIN) || (ulong)weight * slots < rest) continue;
      factors[i] = weight | CERTAIN;
      rest -= weight, --slots, more = true;
    }
  }
  const ulong random = random_of_cell(cell, seed, p);
  ulong place = (rest >> 32) * random + ((rest & UINT_MAX) * random >> 32);  // below rest
  uint kept = 0;
  for (uint i = 0; i < count; ++i) {
    const index_t light = list[i];
    const uint weight = factors[i];
    float factor = 1.0f;
    if (!(weight & CERTAIN)) {
      place += (ulong)weight * slots;
      if (place < rest) continue;
      place -= rest;
      factor = (float)rest / ((float)slots * (float)weight);
    }
    list[kept] = light, factors[kept++] = as_uint(factor);
  }
  cells[cell].y = kept;
}
