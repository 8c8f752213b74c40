// Copies a buffer of rows from the bottom, four 32-bit floats a pixel, into an image. One invocation a pixel.
//   Pixels  storage buffer 0
//   image   at image unit 0
layout(local_size_x = 32, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Pixels { vec4 pixels[]; };
layout(rgba32f, binding = 0) writeonly uniform image2D image;

void main() {
  ivec2 size = imageSize(image), at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  imageStore(image, at, pixels[at.y * size.x + at.x]);
}
