// Lists drawn from a tree of all lights, for GPUs, to the same bytes as culling/cpu/sample_tree.cl, which says
// what the arguments are. A work-group of GROUP items takes a cell: all cut the tree together, then each
// descends from each GROUP-th node.
#define GROUP 32
#include "kernels/culling/sampled_tree.h"

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sample_tree(
    global uint2* cells, global index_t* indices, uint cell_count, uint seed, global uint* factors,
    global const float4* nodes, global const uint* lights, uint leaves, constant float4* world_from_view,
    global const float* bounds, uint planes, global const float* slice_edges, constant CullParams* p) {
  local uint cut[CAP];
  local float errors[CAP];
  const uint cell = get_group_id(0), item = get_local_id(0), first = cell * CAP;
  if (item == 0) cells[cell] = (uint2)(first, 0);
  const CellCentre middle = cell_centre_of(cell, bounds, planes, slice_edges, p);
  if (middle.near > middle.far || !(nodes[2].w > 0.0f)) return;
  const WorldRay ray = world_ray(middle, world_from_view);
  uint count = 1;
  if (item == 0) {
    cut[0] = 1;
    errors[0] = leaves > 1 ? INFINITY : 0.0f;
  }
  while (true) {
    barrier(CLK_LOCAL_MEM_FENCE);
    uint worst = 0;
    float error = errors[0];
    for (uint i = 1; i < count; ++i) {
      const float other = errors[i];
      if (other > error) {
        worst = i;
        error = other;
      }
    }
    if (count == CAP || !(error > 0.0f)) break;
    const uint child = 2 * cut[worst];
    barrier(CLK_LOCAL_MEM_FENCE);
    uint at = worst;
    for (uint node = child; node < child + 2; ++node) {
      const SeenNode seen = seen_node(nodes, node, ray);
      if (!(seen.intensity > 0.0f)) continue;
      if (item == 0) {
        cut[at] = node;
        errors[at] = node < leaves ? error_of(seen) : 0.0f;
      }
      if (at == count) ++count;
      at = count;
    }
  }
  // In ascending order of lights.
  const uint random = random_of_cell(cell, seed, p);
  uint light[(CAP + GROUP - 1) / GROUP], factor[(CAP + GROUP - 1) / GROUP];
  for (uint i = item, n = 0; i < count; i += GROUP, ++n) {
    const DrawnLight drawn = light_of(cut[i], random, seed, cell, nodes, lights, leaves, ray);
    light[n] = drawn.light;
    factor[n] = drawn.factor;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint i = item, n = 0; i < count; i += GROUP, ++n) cut[i] = light[n];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint i = item, n = 0; i < count; i += GROUP, ++n) {
    uint lower = 0;
    for (uint other = 0; other < count; ++other) lower += cut[other] < light[n];
    indices[first + lower] = (index_t)light[n];
    factors[first + lower] = factor[n];
  }
  if (item == 0) cells[cell].y = count;
}
