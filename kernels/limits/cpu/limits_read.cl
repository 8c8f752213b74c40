// Measures the time of reading alone, for CPUs: the limit that kernels are held against (docs/benchmarks.md).
// Item i reads the i-th of global_size equal parts and writes a sum, so that the reads are not left out.
// values  count vectors of 16, a multiple of 8 of them; sums  one uint an item
#include "kernels/common/one_item.h"
#define CHAINS 8u

kernel ONE_ITEM void limits_read(global const uint16* values, uint count, global uint* sums) {
  ASSUME_ONE_ITEM;
  const size_t blocks = count / CHAINS, item = get_global_id(0), items = get_global_size(0);
  global const uint16* p = values + blocks * item / items * CHAINS;
  global const uint16* end = values + blocks * (item + 1) / items * CHAINS;
  uint16 a = 0u, b = 0u, c = 0u, d = 0u;
  for (; p < end; p += CHAINS) {
    a += p[0];
    b += p[1];
    c += p[2];
    d += p[3];
    a += p[4];
    b += p[5];
    c += p[6];
    d += p[7];
  }
  const uint16 sum = a + b + c + d;
  const uint8 s8 = sum.lo + sum.hi;
  const uint4 s4 = s8.lo + s8.hi;
  sums[item] = s4.x + s4.y + s4.z + s4.w;
}
