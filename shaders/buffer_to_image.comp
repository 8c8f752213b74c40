// Copies a buffer of rows from the bottom, without padding, into an image bit by bit. One invocation a pixel.
//   Pixels  storage buffer 0: whole words
//   image   at image unit 0, bound as integers of its own channels and bits
//   BITS a channel (8, 16, 32), CHANNELS (2, 4), FORMAT of the image's integers
//   VOLUME  an image of three dimensions: slice after slice
layout(local_size_x = 32, local_size_y = 8) in;

#if BITS * CHANNELS == 128
#define WORDS uvec4
uvec4 channels_of(uvec4 words) { return words; }
#elif BITS * CHANNELS == 64
#define WORDS uvec2
#if BITS == 32
uvec4 channels_of(uvec2 words) { return uvec4(words, 0u, 0u); }
#else
uvec4 channels_of(uvec2 words) {
  return uvec4(words.x & 65535u, words.x >> 16, words.y & 65535u, words.y >> 16);
}
#endif
#else
#define WORDS uint
#if BITS == 16
uvec4 channels_of(uint word) { return uvec4(word & 65535u, word >> 16, 0u, 0u); }
#else
uvec4 channels_of(uint word) { return uvec4(word, word >> 8, word >> 16, word >> 24) & 255u; }
#endif
#endif

layout(std430) readonly buffer Pixels { WORDS pixels[]; };

uvec4 pixel(int i) {
#if BITS * CHANNELS == 16
  return channels_of(pixels[i / 2] >> (i % 2 * 16)) * uvec4(1u, 1u, 0u, 0u);
#else
  return channels_of(pixels[i]);
#endif
}

#ifdef VOLUME
layout(FORMAT) writeonly uniform uimage3D image;
void main() {
  ivec3 size = imageSize(image), at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, size))) return;
  imageStore(image, at, pixel((at.z * size.y + at.y) * size.x + at.x));
}
#else
layout(FORMAT) writeonly uniform uimage2D image;
void main() {
  ivec2 size = imageSize(image), at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  imageStore(image, at, pixel(at.y * size.x + at.x));
}
#endif
