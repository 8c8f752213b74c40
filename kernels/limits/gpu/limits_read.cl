// Measures the time of reading alone, for GPUs: the same contract as limits/cpu/limits_read.cl, but items
// side by side read side by side, and all of them stride through the buffer together.
// values  count vectors of 4; sums  one uint an item
kernel void limits_read(global const uint4* values, uint count, global uint* sums) {
  const uint item = get_global_id(0), items = get_global_size(0);
  uint4 a = 0u, b = 0u, c = 0u, d = 0u;
  uint i = item;
  for (; i + 3u * items < count; i += 4u * items) {
    a += values[i];
    b += values[i + items];
    c += values[i + 2u * items];
    d += values[i + 3u * items];
  }
  for (; i < count; i += items) a += values[i];
  const uint4 sum = a + b + c + d;
  sums[item] = sum.x + sum.y + sum.z + sum.w;
}
