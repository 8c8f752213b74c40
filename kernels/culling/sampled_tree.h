// Lights drawn from a tree of all lights (kernels/culling/*/sample_tree.cl). C. Yuksel, "Stochastic Lightcuts
// for Sampling Many Lights", TVCG 2020; D. Lin, C. Yuksel, "Real-Time Stochastic Lightcuts", I3D 2020.
//
// The tree is cut into nodes where its lights differ most, seen from the cell; from each a light is drawn by a
// descent that chooses between halves by their weights. A node's interval of random numbers is cut at each
// step, in whole numbers: its last length is the exact probability.
#pragma once

#define LANES 1
#include "kernels/common/index_type.h"
#include "kernels/culling/random_of_cell.h"

// The cell's middle ray in the world: from + distance * along.
typedef struct WorldRay {
  float3 eye, axis, from, along;
  float near, far, size, grows;  // size: half a tile's diagonal, at distance 1 if it grows
} WorldRay;

static inline WorldRay world_ray(CellCentre m, constant float4* world_from_view) {
  const float3 x = world_from_view[0].xyz, y = world_from_view[1].xyz, z = world_from_view[2].xyz;
  const float3 aside = x * m.x + y * m.y;
  WorldRay r;
  r.eye = world_from_view[3].xyz;
  r.axis = -z;
  r.from = m.orthographic ? r.eye + aside : r.eye;
  r.along = m.orthographic ? r.axis : r.axis + aside;
  r.near = m.near;
  r.far = m.far;
  r.size = sqrt(m.half_x * m.half_x + m.half_y * m.half_y);
  r.grows = m.orthographic ? 0.0f : 1.0f;
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

typedef struct DrawnLight {
  uint light, factor;  // float bits: how many times it counts
} DrawnLight;

// random: random_of_cell
static inline DrawnLight light_of(uint node, uint random, uint seed, uint cell, global const float4* nodes,
                                  global const uint* lights, uint leaves, WorldRay ray) {
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
      ++node;
      place -= left;
      range = max(range - left, 1ul);
    }
  }
  const DrawnLight drawn = {lights[node - leaves], as_uint((float)WHOLE_RANGE / (float)range)};
  return drawn;
}
