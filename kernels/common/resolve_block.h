// The surfaces of a block of 4 x 4 pixels: each of its distinct triangles gives the attributes of its pixels,
// then each of their distinct materials the textures.
#pragma once

#include "kernels/common/resolve.h"

// Into attributes and surfaces of zeros. triangle, covered: of each pixel. (x, y): the block's first pixel.
static inline void add_surfaces(Attributes* a, Surface* s, const ResolveScene* scene, uint16 triangle,
                                mask_t covered, uint x, uint y) {
  for (uint left = mask_bits(covered); left != 0;) {
    const uint one = ((const uint*)&triangle)[lowest_bit(left)];
    const mask_t here = triangle == (uint16)(one);
    left &= ~mask_bits(here);
    add_triangle(a, scene, one, here, (float)x, (float)y, BLOCK_DX, BLOCK_DY);
  }
  const whole material = a->material;
  for (uint left = mask_bits(covered); left != 0;) {
    const int one = ((const int*)&material)[lowest_bit(left)];
    const mask_t here = covered & (material == (int16)(one));
    left &= ~mask_bits(here);
    add_material(s, a, scene, (uint)one, here);
  }
}
