// Lists of at most `cap` lights for each cell, drawn from a tree of all lights, and how many times each light
// of a list counts, so that the expected sum of any pixel is that of every light. C. Yuksel, "Stochastic
// Lightcuts for Sampling Many Lights", TVCG 2020; D. Lin, C. Yuksel, "Real-Time Stochastic Lightcuts", I3D
// 2020. A work-item takes a cell.
//
// The tree is cut into `cap` nodes where its lights differ most, seen from the cell; from each a light is
// drawn by a descent that chooses between halves by their weights. A node's interval of random numbers is cut
// at each step, in whole numbers: its last length is the exact probability.
//
// cells, indices, factors  out: the light grid; list i begins at i * cap
// seed       of the random numbers (kernels/culling/random_of_cell.h)
// nodes, lights, leaves  of the tree, two float4 a node (scene/light_tree.h); world space
// world_from_view  axes x, y, z and the eye
// bounds, planes, slice_edges  as kernels/culling/cap_lists.cl says
// -DCAP      cap
#define LANES 1
#include "kernels/common/index_type.h"
#include "kernels/culling/random_of_cell.h"

// The cell's middle ray in the world: from + distance * along.
typedef struct WorldRay {
  float3 eye, axis, from, along;
  float near, far, size, grows;  // size: half a tile's diagonal, at distance 1 if it grows
} WorldRay;

static inline WorldRay world_ray(Middle m, constant float4* world_from_view) {
  const float3 x = world_from_view[0].xyz, y = world_from_view[1].xyz, z = world_from_view[2].xyz;
  const float3 aside = x * m.x + y * m.y;
  WorldRay r;
  r.eye = world_from_view[3].xyz, r.axis = -z;
  r.from = m.orthographic ? r.eye + aside : r.eye;
  r.along = m.orthographic ? r.axis : r.axis + aside;
  r.near = m.near, r.far = m.far;
  r.size = sqrt(m.half_x * m.half_x + m.half_y * m.half_y), r.grows = m.orthographic ? 0.0f : 1.0f;
  return r;
}

typedef struct SeenNode {
  float intensity, distance2, extent2;  // least distance and the box's diagonal, squared
} SeenNode;

static inline SeenNode seen_node(global const float4* nodes, uint node, WorldRay r) {
  const float4 low = nodes[2 * node], high = nodes[2 * node + 1];
  const float3 middle = 0.5f * (low.xyz + high.xyz), away = middle - r.eye, extent = high.xyz - low.xyz;
  const float ahead = (away.x * r.axis.x + away.y * r.axis.y) + away.z * r.axis.z;
  const float distance = fmax(fmin(ahead, r.far), r.near), size = r.grows > 0.0f ? r.size * distance : r.size;
  const float3 at = r.from + r.along * distance;
  const float3 outside = fmax(fmax(low.xyz - at, at - high.xyz), 0.0f);
  SeenNode seen;
  seen.intensity = low.w;
  seen.distance2 = ((outside.x * outside.x + outside.y * outside.y) + outside.z * outside.z) + size * size;
  seen.extent2 = (extent.x * extent.x + extent.y * extent.y) + extent.z * extent.z;
  return seen;
}

// About what a node's lights add to the cell's surfaces, above 0 where they send anything.
static inline float weight_of(SeenNode n) {
  const float weight = n.intensity / (n.distance2 + 0.25f * n.extent2);
  return n.intensity > 0.0f ? (weight > 1e-30f ? fmin(weight, 1e30f) : 1e-30f) : 0.0f;
}

// At most how much it errs to let one of them stand for all; 0 of a single light.
static inline float error_of(SeenNode n) {
  const float error = n.intensity / n.distance2 * (n.extent2 / (n.distance2 + n.extent2));
  return error > 1e-30f ? fmin(error, 1e30f) : 1e-30f;
}

// floor(range * t / 2^32)
static inline ulong part_of(ulong range, ulong t) {
  return (range >> 32) * t + ((range & UINT_MAX) * t >> 32);
}

#define WHOLE_RANGE (1ul << 62)

kernel void sample_tree(global uint2* cells, global index_t* indices, uint cell_count, uint seed,
                        global uint* factors, global const float4* nodes, global const uint* lights,
                        uint leaves, constant float4* world_from_view, global const float* bounds,
                        uint planes, global const float* slice_edges, constant CullParams* p) {
  const uint cell = get_global_id(0);
  if (cell >= cell_count) return;
  const uint first = cell * CAP;
  cells[cell] = (uint2)(first, 0);
  const Middle middle = middle_of(cell, bounds, planes, slice_edges, p);
  if (middle.near > middle.far || !(nodes[2].w > 0.0f)) return;
  const WorldRay ray = world_ray(middle, world_from_view);
  uint cut[CAP], count = 1;
  float errors[CAP];
  cut[0] = 1, errors[0] = leaves > 1 ? INFINITY : 0.0f;
  while (true) {
    uint worst = 0;
    for (uint i = 1; i < count; ++i) worst = errors[i] > errors[worst] ? i : worst;
    if (count == CAP || !(errors[worst] > 0.0f)) break;
    const uint child = 2 * cut[worst];
    uint at = worst;
    for (uint node = child; node < child + 2; ++node) {
      const SeenNode seen = seen_node(nodes, node, ray);
      if (!(seen.intensity > 0.0f)) continue;
      cut[at] = node, errors[at] = node < leaves ? error_of(seen) : 0.0f;
      if (at == count) ++count;
      at = count;
    }
  }
  // In ascending order of lights.
  const uint random = random_of_cell(cell, seed, p);
  for (uint i = 0; i < count; ++i) {
    uint node = cut[i];
    const uint shift = random + mixed(node);
    ulong range = WHOLE_RANGE, place = (ulong)shift << 30 | mixed(shift ^ mixed(seed) ^ cell) >> 2;
    while (node < leaves) {
      node *= 2;
      const float one = weight_of(seen_node(nodes, node, ray)),
                  other = weight_of(seen_node(nodes, node + 1, ray));
      if (!(other > 0.0f)) continue;
      if (!(one > 0.0f)) {
        ++node;
        continue;
      }
      // Neither half is left out, however little it seems to send.
      const float share = fmax(fmin(one / (one + other), 0.999f), 0.001f);
      const ulong left = max(part_of(range, (ulong)(share * 4294967296.0f)), 1ul);
      if (place < left) {
        range = left;
      } else {
        ++node, place -= left, range = max(range - left, 1ul);
      }
    }
    const uint light = lights[node - leaves];
    const uint factor = as_uint((float)WHOLE_RANGE / (float)range);
    uint at = first + i;
    for (; at > first && indices[at - 1] > light; --at)
      indices[at] = indices[at - 1], factors[at] = factors[at - 1];
    indices[at] = (index_t)light, factors[at] = factor;
  }
  cells[cell].y = count;
}
