// The farthest depth of a pixel's SAMPLES, reversed: the least.
uniform sampler2DMS depth_image;

void main() {
  float farthest = 1.0;
  for (int s = 0; s < SAMPLES; ++s)
    farthest = min(farthest, texelFetch(depth_image, ivec2(gl_FragCoord.xy), s).r);
  gl_FragDepth = farthest;
}
