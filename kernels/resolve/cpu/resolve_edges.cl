// Radiance of pixels at edges, for CPUs: a work-item takes a tile, and of it squares of EDGE_BLOCK pixels.
// The surfaces of a square's edge pixels (kernels/resolve/samples.h) are put into the order of their
// triangles, whatever their pixels, and 16 are shaded at a time: along an edge a few triangles meet again and
// again. Other pixels keep their colours: they cost the test of a bit.
//
// triangles, depths  SAMPLES a pixel, side by side: a triangle number or SURFACE_NONE; reversed depth
// edges              a bit a pixel, 16 in a value, of find_edges
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h
// background         of samples without a surface
// image              in and out: RGBA a pixel, linear, row 0 at the bottom
// -DTILE             pixels a side, a multiple of 8 (default 16)
// -DSHADOWS_TRACED   some light casts a shadow in this view: TRACED_ARGUMENTS come first
//                    (kernels/shadows/traced_shadows.h)
// -DSAMPLES, -DSAMPLE_PLACES, and what shared/average.h, resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "shared/average.h"
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/samples.h"
#ifdef SHADOWS_TRACED
#include "kernels/shadows/traced_shadows.h"
#else
#define TRACED_ARGUMENTS
#endif

#define SIDE (TILE < EDGE_BLOCK ? TILE : EDGE_BLOCK)  // 16 at most
#define MOST_SURFACES (SIDE * SIDE * SAMPLES)

// The surfaces of a square's edge pixels, pixel after pixel.
typedef struct EdgeSurfaces {
  uint count;
  float x[MOST_SURFACES], y[MOST_SURFACES];  // from the centre of the first pixel of its EDGE_BLOCK
  float depth[MOST_SURFACES], share[MOST_SURFACES];
  float red[MOST_SURFACES], green[MOST_SURFACES], blue[MOST_SURFACES];
  ulong order[MOST_SURFACES];  // triangle << 16 | surface
} EdgeSurfaces;

#define TRIANGLE_OF(ordered) ((uint)((ordered) >> 16))
#define SURFACE_OF(ordered) ((uint)(ordered) & 0xffffu)

// Shell's method: mostly some dozens.
static inline void sort_by_triangle(EdgeSurfaces* e) {
  for (uint gap = 701; gap > 0; gap = gap == 2 ? 1 : gap * 4 / 9) {
    for (uint i = gap; i < e->count; ++i) {
      const ulong one = e->order[i];
      uint to = i;
      for (; to >= gap && e->order[to - gap] > one; to -= gap) e->order[to] = e->order[to - gap];
      e->order[to] = one;
    }
  }
}

// Which of `count` pixels from `at` on are at edges, a bit each: 16 at most.
static inline uint edge_bits(global const ushort* edges, uint at, uint count) {
  uint bits = edges[at / 16] >> (at & 15u);
  if ((at & 15u) + count > 16) bits |= (uint)edges[at / 16 + 1] << (16 - (at & 15u));
  return bits & first_lanes(count);
}

// Fetches the samples at the edges of a square, which the rasteriser stored past the caches.
static inline void fetch_square(global const uint* triangles, global const float* depths,
                                global const ushort* edges, uint x0, uint y0, uint width, uint height) {
  if (x0 >= width) return;
  for (uint y = y0; y < min(y0 + SIDE, height); ++y) {
    const uint row = y * width + x0;
    for (uint bits = edge_bits(edges, row, min(SIDE, width - x0)); bits != 0; bits &= bits - 1) {
      const size_t at = (size_t)(row + lowest_bit(bits)) * SAMPLES;
      FETCH(triangles + at), FETCH(depths + at);
    }
  }
}

// Surfaces first to first + 15 of the order.
static inline void shade_surfaces(EdgeSurfaces* e, uint first, uint base_x, uint base_y,
                                  const ResolveScene* scene, ResolveLights* lights, constant float* bin_edges,
                                  constant ViewParams* view) {
  uint16 triangle;
  real dx, dy, depth;
  for (uint i = 0; i < 16; ++i) {
    const ulong ordered = e->order[min(first + i, e->count - 1)];
    const uint one = SURFACE_OF(ordered);
    ((uint*)&triangle)[i] = TRIANGLE_OF(ordered);
    ((float*)&dx)[i] = e->x[one], ((float*)&dy)[i] = e->y[one], ((float*)&depth)[i] = e->depth[one];
  }
  const mask_t covered = LANE_INDEX < (int16)((int)(e->count - first));
  const real x = (float)base_x + 0.5f + dx, y = (float)base_y + 0.5f + dy;
#ifdef SHADOWS_TRACED
  trace_from(lights->lights.shadows.traced, covered, x, y, depth, view);
#endif
  Attributes a = {0};
  for (uint left = mask_bits(covered); left != 0;) {
    const uint one = ((const uint*)&triangle)[lowest_bit(left)];
    const mask_t here = triangle == (uint16)(one);
    left &= ~mask_bits(here);
    add_triangle(&a, scene, one, here, (float)base_x, (float)base_y, dx, dy);
#ifdef SHADOWS_TRACED
    trace_from_triangle(lights->lights.shadows.traced, one, scene->triangle_instance, here);
#endif
  }
  Surface s = {0};
  add_materials(&s, &a, scene, covered);
  const Real3 shown = radiance(&a, &s, x, y, depth, covered, lights, bin_edges, view);
  for (uint i = 0; i < 16 && first + i < e->count; ++i) {
    const uint one = SURFACE_OF(e->order[first + i]);
    e->red[one] = LANE(shown.x, i), e->green[one] = LANE(shown.y, i), e->blue[one] = LANE(shown.z, i);
  }
}

kernel void resolve_edges(TRACED_ARGUMENTS global const uint* triangles, global const float* depths,
                          global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                          global float* image) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, tile_y * view->tiles_x + tile_x, view);
#ifdef SHADOWS_TRACED
  TracedShadows traced = TRACED_SHADOWS;
  lights.lights.shadows.traced = &traced;
#elif defined(SHADOWS)
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
#endif
  EdgeSurfaces e;
  uint pixels[SIDE * SIDE];
  float4 colors[SIDE * SIDE];
  ushort ends[SIDE * SIDE];  // of each pixel's surfaces
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      const uint base_x = x0 & ~(EDGE_BLOCK - 1u), base_y = y0 & ~(EDGE_BLOCK - 1u);
      uint found = 0;
      e.count = 0;
      fetch_square(triangles, depths, edges, x0 + SIDE, y0, width, height);
      for (uint y = y0; y < min(y0 + SIDE, height); ++y) {
        uint bits = edge_bits(edges, y * width + x0, min(SIDE, width - x0));
        for (; bits != 0; bits &= bits - 1) {
          const uint x = x0 + lowest_bit(bits), at = y * width + x;
          float4 color = 0.0f;
          for (uint left = ALL_SAMPLES; left != 0;) {
            const PixelSurface p =
                next_surface(triangles + (size_t)at * SAMPLES, depths + (size_t)at * SAMPLES, &left);
            if (p.triangle == SURFACE_NONE) {
              color = begun_with(background, p.share);
              continue;
            }
            const uint one = e.count++;
            e.order[one] = (ulong)p.triangle << 16 | one, e.share[one] = p.share, e.depth[one] = p.depth;
            e.x[one] = (float)(x - base_x) + p.off_x, e.y[one] = (float)(y - base_y) + p.off_y;
          }
          pixels[found] = at, colors[found] = color, ends[found++] = (ushort)e.count;
        }
      }
      if (e.count == 0) continue;
      sort_by_triangle(&e);
      for (uint i = 0; i < e.count; i += 16)
        shade_surfaces(&e, i, base_x, base_y, &scene, &lights, bin_edges, view);
      for (uint i = 0, one = 0; i < found; ++i) {
        float4 color = colors[i];
        for (; one < ends[i]; ++one)
          color = add_light(color, (float3)(e.red[one], e.green[one], e.blue[one]), e.share[one]);
        vstore4(averaged(color), pixels[i], image);
      }
    }
  }
}
