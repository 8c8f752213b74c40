// The surface of every pixel of a visibility buffer into a geometry buffer, for CPUs: a work-item takes a
// tile, block after block of 4 x 4 pixels. As resolve/cpu/resolve.cl up to the surfaces; lights come from
// shade_tiles.
//
// triangles, depths  a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; of the lights only directional ones are read
// background  of pixels without a surface
// first, second, coats  out: the geometry buffer (kernels/resolve/gbuffer.h); coats and
//             specular null: none is wanted
// image       out: RGBA a pixel, what surfaces show without point and spot lights; null: the light pass adds
// it
//
// -DTILE         pixels a side, a multiple of 8 (default 16)
// -DBUFFER_BITS  kernels/resolve/gbuffer.h
// -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/resolve_light.h"

#if BUFFER_BITS == 32
static inline void store_texels(global float* to, Texels t, uint x, uint y, uint width, uint height) {
  store_block(to, real3(t.x, t.y, t.z), t.w, x, y, width, height);
}
#else
#if BUFFER_BITS == 16
#define TO_CHANNELS(row) convert_ushort16_sat_rte(row)
#else
#define TO_CHANNELS(row) convert_uchar16_sat_rte(row)
#endif
static inline void store_texels(global channel_t* to, Texels t, uint x, uint y, uint width, uint height) {
  float16 rows[4];
  rows_of_block(rows, real3(t.x, t.y, t.z), t.w);
  const uint columns = min(width - x, 4u), lines = min(height - y, 4u);
  for (uint line = 0; line < lines; ++line) {
    global channel_t* at = to + 4 * ((size_t)(y + line) * width + x);
    if (columns == 4) {
      vstore16(TO_CHANNELS(rows[line]), 0, at);
      continue;
    }
    channel_t row[16];
    vstore16(TO_CHANNELS(rows[line]), 0, row);
    for (uint i = 0; i < 4 * columns; ++i) at[i] = row[i];
  }
}
#endif

kernel void resolve_gbuffer(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                            float4 background, global channel_t* first, global channel_t* second,
                            global channel_t* coats, global channel_t* specular, global float* image
                            GROUP_NUMBERS_OUT) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      const Attributes* a = block_attributes(&walk, covered, x, y);
      Surface s = {0};
      add_materials(&s, a, &scene, covered);
      const Real3 n = shading_normal(a, &s);
      Texels normal, color;
      texels_of_surface(&normal, &color, n, s.base_color, s.metallic, s.roughness, number_of(&s), s.unlit,
                        covered);
      store_texels(first, normal, x, y, width, height);
      store_texels(second, color, x, y, width, height);
#ifdef CLEARCOAT
      if (coats) {
        const Texels coat = texels_of_coat(coat_normal(a, &s), n, s.coat, s.coat_roughness, covered);
        store_texels(coats, coat, x, y, width, height);
      }
#endif
#ifdef SPECULAR
      if (specular) store_texels(specular, texels_of_specular(s.f0, s.f90, covered), x, y, width, height);
#endif
#ifdef GROUP_NUMBERS
      store_group_numbers(group_numbers, a->group_number, covered, x, y, width, height);
#endif
      if (!image) continue;
      const real depth = block_depths(&walk, depths, x, y);
      light_pixels(&lights.lights, x, y, view);
      const ShadingPoint p =
          resolved_point(a, &s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth, covered, view);
      const Real3 shown = base_light(&p, &s, covered, &lights, view);
      store_block(image,
                  real3(covered ? shown.x : REAL(background.x), covered ? shown.y : REAL(background.y),
                        covered ? shown.z : REAL(background.z)),
                  REAL(1.0f), x, y, width, height);
    }
  }
}
