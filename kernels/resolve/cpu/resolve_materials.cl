// Radiance of every pixel of a visibility buffer under its sums of light, for CPUs: a work-item takes a tile,
// block after block of 4 x 4 pixels. The material pass of light_prepass where OpenCL rasterises.
//
// triangles, depths  a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; of the lights only directional ones are read
// background  of pixels without a surface
// first, second  the light buffer (kernels/resolve/cpu/light_buffer.cl)
// scale       what its values are multiplied by
// exponent, reference  LightBufferParams (shared/light_buffer.h)
// image       out: RGBA a pixel, linear, row 0 at the bottom
// -DTILE      pixels a side, a multiple of 8 (default 16)
// -DSAMPLES, -DSAMPLES_APART  kernels/resolve/resolve_sums.h; pixels at edges have no triangle here
// -DPREPASS_…, -DBUFFER_BITS, -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_sums.h"

// Of pixels of one surface: the mean over the samples that have sums of their own.
static inline Real3 shown_by_block(const Attributes* a, const Surface* s, real depth, mask_t covered,
                                   global const light_channel_t* first, global const light_channel_t* second,
                                   float scale, LightBufferParams of, const ResolveLights* lights, uint x,
                                   uint y, constant ViewParams* view) {
  Real3 shown = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#pragma unroll 1
  for (uint sample = 0; sample < READ_SAMPLES; ++sample) {
    size_t at[16];
    for (uint i = 0; i < 16; ++i)
      at[i] = ((size_t)min(y + i / 4, view->height - 1) * view->width + min(x + i % 4, view->width - 1)) *
                  SAMPLES +
              sample;
    const Real3 one = radiance_of_sums(a, s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth,
                                       covered, stored_sums(first, second, scale, at), of, lights, view);
    shown = add3(shown, scale3(one, REAL(1.0f / READ_SAMPLES)));
  }
  return shown;
}

kernel void resolve_materials(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                              float4 background, global const light_channel_t* first,
                              global const light_channel_t* second, float scale, float exponent,
                              float reference, global float* image) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const LightBufferParams of = {REAL(exponent), REAL(reference)};
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      Real3 color = real3(REAL(background.x), REAL(background.y), REAL(background.z));
      if (any_lane(covered)) {
        const Attributes* a = block_attributes(&walk, covered, x, y);
        Surface s = {0};
        add_materials(&s, a, &scene, covered);
        const real depth = block_depths(&walk, depths, x, y);
        light_pixels(&lights.lights, x, y, view);
        const Real3 shown =
            shown_by_block(a, &s, depth, covered, first, second, scale, of, &lights, x, y, view);
        color = real3(covered ? shown.x : color.x, covered ? shown.y : color.y, covered ? shown.z : color.z);
      }
      store_block(image, color, REAL(1.0f), x, y, width, height);
    }
  }
}
