// The surfaces of pixels at edges, for CPUs. Those of a square of a tile's pixels (kernels/resolve/samples.h)
// are put into the order of their triangles, whatever their pixels, and 16 are taken at a time: along an edge
// a few triangles meet again and again. Other pixels cost the test of a bit.
//
// triangles, depths  SAMPLES a pixel, side by side: a triangle number or SURFACE_NONE; reversed depth
// edges              a bit a pixel, 16 in a value, of find_edges
// -DTILE             pixels a side, a multiple of 8 (default 16)
// -DSAMPLES, -DSAMPLE_PLACES, and what shared/average.h and resolve.h name
#pragma once

#include "kernels/common/interleave.h"
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/samples.h"
#include "kernels/resolve/texel_places.h"
#include "shared/average.h"

#define SIDE (TILE < EDGE_BLOCK ? TILE : EDGE_BLOCK)  // 16 at most
#define MOST_PIXELS (SIDE * SIDE)
#define MOST_SURFACES (MOST_PIXELS * SAMPLES)

// The edge pixels of a square, in groups of 16, and their surfaces. A group has 16 slots for each sample, one per
// pixel. A slot is in use if no earlier sample of its pixel sees the same triangle.
typedef struct EdgeSurfaces {
  uint pixel_count, count;
  uint base_x, base_y;                                        // the first pixel of its EDGE_BLOCK
  uint16 pixels[MOST_PIXELS / 16], places[MOST_PIXELS / 16];  // places: x | y << 8 from there on
  int16 missed[MOST_PIXELS / 16];                             // samples that see no surface, as a mask
  // By slot:
  int16 triangle[MOST_SURFACES / 16], samples[MOST_SURFACES / 16];  // samples: those that see it, as a mask
  float16 x[MOST_SURFACES / 16], y[MOST_SURFACES / 16];             // from the base's centre
  float16 depth[MOST_SURFACES / 16];
  float red[MOST_SURFACES], green[MOST_SURFACES], blue[MOST_SURFACES];
  // The slots in use, and their triangles; then the slots sorted by triangle within runs of SORTED_RUN.
  ushort slots[MOST_SURFACES], order[MOST_SURFACES];
  int16 triangles[MOST_SURFACES / 16];
} EdgeSurfaces;

#define ELEMENT(type, vectors, i) (((const type*)(vectors))[i])
#define SORTED_RUN 256u  // time grows with its square

static inline uint pixel_of_slot(const EdgeSurfaces* e, uint slot) {
  return ELEMENT(uint, e->pixels, slot / (16 * SAMPLES) * 16 + slot % 16);
}

// A surface's place is the number of surfaces that come before it. Each lane counts for a surface of its own,
// without branches.
static inline void sort_run(EdgeSurfaces* e, uint first, uint end) {
  const int* all = (const int*)e->triangles;
  for (uint i = first; i < end; i += 16) {
    const uint own_end = min(i + 16, end);
    const int16 triangles = e->triangles[i / 16];
    int16 place = (int16)((int)first);
    for (uint k = first; k < i; ++k) place -= (int16)(all[k]) <= triangles;
    for (uint k = i; k < own_end; ++k) {
      const int16 other = all[k];
      place -= (other < triangles) | ((other == triangles) & ((int16)((int)(k - i)) < LANE_INDEX));
    }
    for (uint k = own_end; k < end; ++k) place -= (int16)(all[k]) < triangles;
    for (uint k = i; k < own_end; ++k) e->order[((const int*)&place)[k - i]] = e->slots[k];
  }
}

// Fetches the corners of a sorted run's triangles, whose instances add_surfaces began to fetch.
static inline void fetch_run(const EdgeSurfaces* e, const ResolveScene* scene, uint first, uint end) {
  uint found[SORTED_RUN], places[SORTED_RUN], count = 0;
  for (uint i = first; i < end; ++i) {
    const uint one = ELEMENT(uint, e->triangle, e->order[i]);
    if (i == first || one != found[count - 1]) found[count++] = one;
  }
  fetch_corners(scene, found, places, count);
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
      FETCH(triangles + at);
      FETCH(depths + at);
    }
  }
}

// Loads SAMPLES values of each pixel of a group: to[s] has those of sample s, one lane per pixel.
static inline void load_group(const EdgeSurfaces* e, uint first, global const uint* values, uint16* to) {
  for (uint i = 0; i < 16; ++i) {
    global const uint* of_pixel =
        values + (size_t)ELEMENT(uint, e->pixels, min(first + i, e->pixel_count - 1)) * SAMPLES;
#pragma unroll
    for (uint s = 0; s < SAMPLES; ++s) ((uint*)to)[i * SAMPLES + s] = of_pixel[s];
  }
  separate(to);
}

// Adds the surfaces of the 16 pixels from number `first` on, one lane per pixel. Each surface lies at the
// centroid of the samples that see it (kernels/resolve/samples.h).
static inline void add_surfaces(EdgeSurfaces* e, const ResolveScene* scene, uint first,
                                global const uint* triangles, global const float* depths) {
  uint16 seen[SAMPLES], depth[SAMPLES];
  load_group(e, first, triangles, seen);
  load_group(e, first, (global const uint*)depths, depth);
  const int16 place = as_int16(e->places[first / 16]);
  const float16 pixel_x = convert_float16(place & 255), pixel_y = convert_float16(place >> 8);
  const mask_t in_group = LANE_INDEX < (int16)((int)(e->pixel_count - first));
  int16 missed = 0;
#pragma unroll
  for (uint s = 0; s < SAMPLES; ++s) {
    mask_t own = in_group & (seen[s] != (uint16)(SURFACE_NONE));
    missed |= (seen[s] == (uint16)(SURFACE_NONE)) & (int16)(1 << s);
#pragma unroll
    for (uint k = 0; k < s; ++k) own &= seen[k] != seen[s];
    int16 samples = 0, count = 0, x = 0, y = 0;
    float16 sum = 0.0f;
#pragma unroll
    for (uint k = s; k < SAMPLES; ++k) {
      const mask_t here = seen[k] == seen[s];
      samples |= here & (int16)(1 << k);
      count -= here;
      x += here & (int16)(SAMPLE_UNITS_X(k));
      y += here & (int16)(SAMPLE_UNITS_Y(k));
      sum += here ? as_float16(depth[k]) : (float16)(0.0f);
    }
    const uint group = first / 16 * SAMPLES + s;
    const float16 mean = 1.0f / convert_float16(count);
    e->triangle[group] = as_int16(seen[s]);
    e->samples[group] = own & samples;
    e->depth[group] = sum * mean;
    e->x[group] = pixel_x + convert_float16(x) * (mean / 256);
    e->y[group] = pixel_y + convert_float16(y) * (mean / 256);
    for (uint left = mask_bits(own); left != 0; left &= left - 1) {
      const uint slot = group * 16 + lowest_bit(left), one = ELEMENT(uint, e->triangle, slot);
      FETCH(scene->triangle_instance + one);
      ((uint*)e->triangles)[e->count] = one;
      e->slots[e->count++] = (ushort)slot;
    }
  }
  e->missed[first / 16] = missed;
}

// Finds the surfaces of the square from (x0, y0) on.
static inline void find_edge_surfaces(EdgeSurfaces* e, const ResolveScene* scene,
                                      global const uint* triangles, global const float* depths,
                                      global const ushort* edges, uint x0, uint y0, uint width, uint height) {
  e->base_x = x0 & ~(EDGE_BLOCK - 1u);
  e->base_y = y0 & ~(EDGE_BLOCK - 1u);
  e->pixel_count = e->count = 0;
  fetch_square(triangles, depths, edges, x0 + SIDE, y0, width, height);
  for (uint y = y0; y < min(y0 + SIDE, height); ++y) {
    const uint row = y * width + x0;
    const uint place = (y - e->base_y) << 8 | (x0 - e->base_x);
    for (uint bits = edge_bits(edges, row, min(SIDE, width - x0)); bits != 0; bits &= bits - 1) {
      ((uint*)e->pixels)[e->pixel_count] = row + lowest_bit(bits);
      ((uint*)e->places)[e->pixel_count++] = place + lowest_bit(bits);
    }
  }
  for (uint i = 0; i < e->pixel_count; i += 16) add_surfaces(e, scene, i, triangles, depths);
  for (uint first = 0; first < e->count; first += SORTED_RUN) {
    const uint end = min(first + SORTED_RUN, e->count);
    sort_run(e, first, end);
    fetch_run(e, scene, first, end);
  }
}

// Surfaces first to first + 15 of the order.
typedef struct EdgeBatch {
  uint slot[16];
  mask_t covered;
  uint16 triangle;
  real x, y, depth;  // place in pixels; reversed depth
  Attributes attributes;
  Surface material;
} EdgeBatch;

static inline void take_batch(EdgeBatch* b, const EdgeSurfaces* e, uint first, const ResolveScene* scene) {
  const Attributes no_attributes = {0};
  const Surface no_material = {0};
  b->attributes = no_attributes;
  b->material = no_material;
  real dx, dy;
  for (uint i = 0; i < 16; ++i) {
    const uint slot = b->slot[i] = e->order[min(first + i, e->count - 1)];
    ((int*)&b->triangle)[i] = ELEMENT(int, e->triangle, slot);
    ((float*)&dx)[i] = ELEMENT(float, e->x, slot);
    ((float*)&dy)[i] = ELEMENT(float, e->y, slot);
    ((float*)&b->depth)[i] = ELEMENT(float, e->depth, slot);
  }
  b->covered = LANE_INDEX < (int16)((int)(e->count - first));
  b->x = (float)e->base_x + 0.5f + dx;
  b->y = (float)e->base_y + 0.5f + dy;
  for (uint left = mask_bits(b->covered); left != 0;) {
    const uint one = ((const uint*)&b->triangle)[lowest_bit(left)];
    const mask_t here = b->triangle == (uint16)(one);
    left &= ~mask_bits(here);
    add_triangle(&b->attributes, scene, one, here, (float)e->base_x, (float)e->base_y, dx, dy);
  }
  add_materials(&b->material, &b->attributes, scene, b->covered);
}

// Where these surfaces' texels go in images of samples.
static inline TexelPlaces texels_of_batch(const EdgeSurfaces* e, uint first) {
  TexelPlaces to;
  to.count = 0;
  for (uint i = 0; i < min(e->count - first, 16u); ++i) {
    const uint slot = e->order[first + i];
    add_texels(&to, i, pixel_of_slot(e, slot), ELEMENT(uint, e->samples, slot));
  }
  return to;
}

static inline void keep_light(EdgeSurfaces* e, const EdgeBatch* b, Real3 light) {
  for (uint i = 0; i < 16; ++i) {
    if (!LANE(b->covered, i)) continue;
    const uint slot = b->slot[i];
    e->red[slot] = LANE(light.x, i);
    e->green[slot] = LANE(light.y, i);
    e->blue[slot] = LANE(light.z, i);
  }
}

// The averages of the light of pixels' surfaces into the image.
static inline void show_edges(const EdgeSurfaces* e, float4 background, global float* image) {
  for (uint i = 0; i < e->pixel_count; ++i) {
    const uint missed = ELEMENT(uint, e->missed, i);
    float4 color = missed ? begun_with(background, share_of(missed)) : (float4)(0.0f);
    for (uint s = 0; s < SAMPLES; ++s) {
      const uint slot = (i / 16 * SAMPLES + s) * 16 + i % 16, samples = ELEMENT(uint, e->samples, slot);
      if (samples == 0) continue;
      color = add_light(color, (float3)(e->red[slot], e->green[slot], e->blue[slot]), share_of(samples));
    }
    vstore4(averaged(color), ELEMENT(uint, e->pixels, i), image);
  }
}
