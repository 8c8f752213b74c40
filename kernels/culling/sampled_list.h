// Lists drawn at random (kernels/culling/*/sample_lists.cl): what a light weighs, and how often one counts
// that was drawn.
//
// Systematic sampling with probabilities in proportion to weights (Madow 1949): a light whose share of the
// slots would be one or more is kept for certain and counts once; the others are laid end to end, as long as
// their weights, and one is drawn in each of as many equal steps as slots are left, at the same random place
// in all. Weights are whole numbers from here on, so that the probabilities are exact whatever was rounded
// before.
#pragma once

#define LANES 1
#include "kernels/common/index_type.h"
#include "kernels/common/light_columns.h"
#include "kernels/culling/random_of_cell.h"

// Beside a weight, which is 2^24 at most: the light is kept for certain.
#define CERTAIN 0x80000000u

// About what a light adds to the cell's surfaces. What the middle does not see of it, past its range or its
// cone, other pixels may: a sixteenth of the light without either counts in any case.
static inline float weight_of(PunctualLight light, CellCentre m) {
  const float4 at = point_of_centre(-light.position.z, m);
  const Real3 middle = real3(at.x, at.y, -at.z), to_light = offset_to_light(middle, light);
  const float across = m.half_x * at.w, up = m.half_y * at.w, size2 = across * across + up * up;
  const float inverse = 1.0f / (dot3(to_light, to_light) + size2);
  const float light_there = fmin(arrival_at(middle, light).attenuation, inverse) + 0.0625f * inverse;
  const float weight =
      light_there * (0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z);
  return weight > 1e-30f ? fmin(weight, 1e30f) : 1e-30f;
}

// The integer weight of the heaviest light of a list.
#define MOST_WEIGHT 16777216.0f

static inline uint whole_weight(float weight, float scale) { return max((uint)(weight * scale), 1u); }

// The place of the first step, below `rest`: the sum of the weights of lights that are not certain.
static inline ulong first_place(ulong rest, ulong random) {
  return (rest >> 32) * random + ((rest & UINT_MAX) * random >> 32);
}

// One over the probability of a light that is not certain.
static inline float factor_of(ulong rest, uint slots, uint weight) {
  return (float)rest / ((float)slots * (float)weight);
}
