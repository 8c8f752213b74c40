// Copies an image into a buffer as glReadPixels does: rows from the bottom, without
// padding. One invocation a pixel.
//   image   at texture unit 0
//   Pixels  storage buffer 0
//   one of  FLOAT_1 (its first channel, or depth), FLOAT_4: 32 bits a channel
//           UNORM8_4, UNORM16_2, UNORM16_4: the integers that the image stores
//           UINT8_1, UINT16_1: its first channel, several in a word
//   SAMPLES: so many a pixel, which follow one another
layout(local_size_x = 32, local_size_y = 8) in;
#if defined(UINT8_1)
#define UINTS_OF_WORD 4
#elif defined(UINT16_1)
#define UINTS_OF_WORD 2
#endif
#if defined(SAMPLES) && defined(UINTS_OF_WORD)
uniform usampler2DMS image;
#elif defined(SAMPLES)
uniform sampler2DMS image;
#elif defined(UINTS_OF_WORD)
uniform usampler2D image;
#else
uniform sampler2D image;
#endif
#ifndef SAMPLES
#define SAMPLES 1
#endif

#if defined(UINTS_OF_WORD)
#define PIXEL uint
#elif defined(FLOAT_1)
#define PIXEL uint
PIXEL pixel_of(vec4 texel) { return floatBitsToUint(texel.r); }
#elif defined(FLOAT_4)
#define PIXEL uvec4
PIXEL pixel_of(vec4 texel) { return floatBitsToUint(texel); }
#elif defined(UNORM8_4)
#define PIXEL uint
PIXEL pixel_of(vec4 texel) { return packUnorm4x8(texel); }
#elif defined(UNORM16_2)
#define PIXEL uint
PIXEL pixel_of(vec4 texel) { return packUnorm2x16(texel.rg); }
#else  // UNORM16_4
#define PIXEL uvec2
PIXEL pixel_of(vec4 texel) { return uvec2(packUnorm2x16(texel.rg), packUnorm2x16(texel.ba)); }
#endif

layout(std430) writeonly buffer Pixels { PIXEL pixels[]; };

void main() {
#if SAMPLES > 1
  ivec2 size = textureSize(image);
#else
  ivec2 size = textureSize(image, 0);
#endif
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
#ifdef UINTS_OF_WORD
  // The words that begin with a sample of this pixel.
  int first = (at.y * size.x + at.x) * SAMPLES, end = first + SAMPLES;
  for (int i = (first + UINTS_OF_WORD - 1) / UINTS_OF_WORD * UINTS_OF_WORD; i < end; i += UINTS_OF_WORD) {
    uint word = 0u;
    for (int k = 0; k < UINTS_OF_WORD; ++k) {
      int pixel = (i + k) / SAMPLES;
      if (pixel >= size.x * size.y) break;
      word |= texelFetch(image, ivec2(pixel % size.x, pixel / size.x), (i + k) % SAMPLES).r
              << (32 / UINTS_OF_WORD * k);
    }
    pixels[i / UINTS_OF_WORD] = word;
  }
#else
  // With one sample, s = 0 is the level.
  for (int s = 0; s < SAMPLES; ++s)
    pixels[(at.y * size.x + at.x) * SAMPLES + s] = pixel_of(texelFetch(image, at, s));
#endif
}
