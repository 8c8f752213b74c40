// Lists of at most `cap` lights for each cell, drawn from a tree of all lights, and how many times each light
// of a list counts, so that the expected sum of any pixel is that of every light
// (kernels/culling/sampled_tree.h). A work-item takes a cell.
//
// cells, indices, factors  out: the light grid; list i begins at i * cap
// seed       of the random numbers (kernels/culling/random_of_cell.h)
// nodes, lights, leaves  of the tree, two float4 a node (scene/light_tree.h); world space
// world_from_view  axes x, y, z and the eye
// bounds, planes, slice_edges  as kernels/culling/cap_lists.cl says
// -DCAP      cap
#include "kernels/culling/sampled_tree.h"

kernel void sample_tree(global uint2* cells, global index_t* indices, uint cell_count, uint seed,
                        global uint* factors, global const float4* nodes, global const uint* lights,
                        uint leaves, constant float4* world_from_view, global const float* bounds,
                        uint planes, global const float* slice_edges, constant CullParams* p) {
  const uint cell = get_global_id(0);
  if (cell >= cell_count) return;
  const uint first = cell * CAP;
  cells[cell] = (uint2)(first, 0);
  const CellCentre middle = cell_centre_of(cell, bounds, planes, slice_edges, p);
  if (middle.near > middle.far || !(nodes[2].w > 0.0f)) return;
  const WorldRay ray = world_ray(middle, world_from_view);
  uint cut[CAP], count = 1;
  float errors[CAP];
  cut[0] = 1;
  errors[0] = leaves > 1 ? INFINITY : 0.0f;
  while (true) {
    uint worst = 0;
    for (uint i = 1; i < count; ++i) worst = errors[i] > errors[worst] ? i : worst;
    if (count == CAP || !(errors[worst] > 0.0f)) break;
    const uint child = 2 * cut[worst];
    uint at = worst;
    for (uint node = child; node < child + 2; ++node) {
      const SeenNode seen = seen_node(nodes, node, ray);
      if (!(seen.intensity > 0.0f)) continue;
      cut[at] = node;
      errors[at] = node < leaves ? error_of(seen) : 0.0f;
      if (at == count) ++count;
      at = count;
    }
  }
  // In ascending order of lights.
  const uint random = random_of_cell(cell, seed, p);
  for (uint i = 0; i < count; ++i) {
    const DrawnLight drawn = light_of(cut[i], random, seed, cell, nodes, lights, leaves, ray);
    uint at = first + i;
    for (; at > first && indices[at - 1] > drawn.light; --at) {
      indices[at] = indices[at - 1];
      factors[at] = factors[at - 1];
    }
    indices[at] = (index_t)drawn.light;
    factors[at] = drawn.factor;
  }
  cells[cell].y = count;
}
