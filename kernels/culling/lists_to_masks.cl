// Light lists as bitmasks: a work-item takes a cell and walks its list, which is sorted, word by word.
//
// cells, indices  the light grid
// masks           `words` words a cell: light i is bit i % 32 of word i / 32
#include "kernels/common/index_type.h"

kernel void lists_to_masks(global const uint2* cells, global const index_t* indices, uint cell_count,
                           uint words, global uint* masks) {
  const uint cell = get_global_id(0);
  if (cell >= cell_count) return;
  masks += (size_t)cell * words;
  uint i = cells[cell].x;
  const uint end = i + cells[cell].y;
  for (uint w = 0; w < words; ++w) {
    uint bits = 0;
    for (; i < end && indices[i] / 32 == w; ++i) bits |= 1u << (indices[i] & 31);
    masks[w] = bits;
  }
}
