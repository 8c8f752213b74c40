// As resolve/cpu/find_edges.cl, with the same arguments: a work-item takes 16 pixels.
#define LANES 1
#include "kernels/resolve/join_surfaces.h"

kernel void find_edges(global uint* triangles, global const float* depths,
                       global const uint* triangle_instance, global const RasterInstanceRecord* instances,
                       global const uint* indices, global const float4* clip, uint width, uint height,
                       global uint* pixel_triangles, global float* pixel_depths, global ushort* edges) {
  const SeenTriangles scene = {triangle_instance, instances, indices, clip};
  const float2 half_size = (float2)(0.5f * (float)width, 0.5f * (float)height);
  const uint pixels = width * height, begin = (uint)get_global_id(0) * 16, end = min(begin + 16, pixels);
  if (begin >= pixels) return;
  uint bits = 0;
  for (uint at = begin; at < end; ++at) {
    const size_t first = (size_t)at * SAMPLES;
    uint seen = triangles[first];
    float depth = depths[first];
    bool edge = false;
    for (uint s = 1; s < SAMPLES; ++s) {
      edge = edge || triangles[first + s] != seen;
      depth += depths[first + s];
    }
    depth *= 1.0f / SAMPLES;
    if (edge &&
        join_surfaces(triangles + first, &scene, at % width, at / width, half_size, depths + first, &depth)) {
      edge = false;
      seen = triangles[first];
    }
    pixel_triangles[at] = edge ? SURFACE_NONE : seen;
    pixel_depths[at] = edge ? 0.0f : depth;
    bits |= edge ? 1u << (at - begin) : 0u;
  }
  edges[begin / 16] = (ushort)bits;
}
