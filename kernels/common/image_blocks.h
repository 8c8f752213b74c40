// Blocks of 4 x 4 pixels of images, a lane each, row by row from the lower left.
#pragma once

#include "shared/real.h"

#if LANES == 16

// 4 x 4 values of an image from (x, y) on. Where the block ends outside, rows and columns stop at the image's
// last.
static inline uint16 load_block(global const uint* values, uint x, uint y, uint width, uint height) {
  global const uint* at = values + (size_t)y * width + x;
  if (x + 4 <= width && y + 4 <= height) {
    return (uint16)(vload4(0, at), vload4(0, at + width), vload4(0, at + 2 * (size_t)width),
                    vload4(0, at + 3 * (size_t)width));
  }
  uint block[16];
  for (uint i = 0; i < 16; ++i)
    block[i] = values[(size_t)min(y + i / 4, height - 1) * width + min(x + i % 4, width - 1)];
  return vload16(0, block);
}

// Four pixels. Past the caches where they are a whole cache line: the image is larger than the caches, and of
// what they hold, texels are needed again. An ordinary store would also read the line first.
static inline void store_row(float16 row, global float* to) {
#ifdef __clang__
  if (((size_t)to & 63u) == 0) {
    __builtin_nontemporal_store(row, (global float16*)to);
    return;
  }
#endif
  vstore16(row, 0, to);
}

// Makes the rows of a block: x, y, z and w of four pixels each.
static inline void rows_of_block(float16* rows, Real3 c, real w) {
  rows[0] = (float16)(c.x.s0, c.y.s0, c.z.s0, w.s0, c.x.s1, c.y.s1, c.z.s1, w.s1, c.x.s2, c.y.s2, c.z.s2,
                      w.s2, c.x.s3, c.y.s3, c.z.s3, w.s3);
  rows[1] = (float16)(c.x.s4, c.y.s4, c.z.s4, w.s4, c.x.s5, c.y.s5, c.z.s5, w.s5, c.x.s6, c.y.s6, c.z.s6,
                      w.s6, c.x.s7, c.y.s7, c.z.s7, w.s7);
  rows[2] = (float16)(c.x.s8, c.y.s8, c.z.s8, w.s8, c.x.s9, c.y.s9, c.z.s9, w.s9, c.x.sa, c.y.sa, c.z.sa,
                      w.sa, c.x.sb, c.y.sb, c.z.sb, w.sb);
  rows[3] = (float16)(c.x.sc, c.y.sc, c.z.sc, w.sc, c.x.sd, c.y.sd, c.z.sd, w.sd, c.x.se, c.y.se, c.z.se,
                      w.se, c.x.sf, c.y.sf, c.z.sf, w.sf);
}

// The way back: the four channels.
static inline void channels_of_rows(real* channels, const float16* rows) {
  channels[0] = (float16)(rows[0].s048c, rows[1].s048c, rows[2].s048c, rows[3].s048c);
  channels[1] = (float16)(rows[0].s159d, rows[1].s159d, rows[2].s159d, rows[3].s159d);
  channels[2] = (float16)(rows[0].s26ae, rows[1].s26ae, rows[2].s26ae, rows[3].s26ae);
  channels[3] = (float16)(rows[0].s37bf, rows[1].s37bf, rows[2].s37bf, rows[3].s37bf);
}

static inline void store_block(global float* image, Real3 c, real w, uint x, uint y, uint width,
                               uint height) {
  float16 rows[4];
  rows_of_block(rows, c, w);
  global float* at = image + 4 * ((size_t)y * width + x);
  const uint columns = min(width - x, 4u), lines = min(height - y, 4u);
  if (columns == 4) {
    for (uint row = 0; row < lines; ++row) store_row(rows[row], at + 4 * (size_t)width * row);
    return;
  }
  for (uint row = 0; row < lines; ++row) {
    for (uint i = 0; i < 4 * columns; ++i) at[4 * (size_t)width * row + i] = ((const float*)&rows[row])[i];
  }
}
#endif

// The four channels of LANES pixels.
static inline void channels_of_pixels(real* channels, const float4* pixels) {
#if LANES == 16
  float16 rows[4];
#pragma unroll
  for (uint i = 0; i < 4; ++i)
    rows[i] = (float16)(pixels[4 * i], pixels[4 * i + 1], pixels[4 * i + 2], pixels[4 * i + 3]);
  channels_of_rows(channels, rows);
#else
  channels[0] = pixels[0].x;
  channels[1] = pixels[0].y;
  channels[2] = pixels[0].z;
  channels[3] = pixels[0].w;
#endif
}
