// An empty launch, to measure its cost. The argument keeps drivers from removing it.
kernel void limits_empty(global uint* unused) {
  if (get_global_id(0) == 0xffffffffu) unused[0] = 0u;
}
