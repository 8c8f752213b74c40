// The values of a pixel whose instance is not known, by the number of its surface in an image
// (src/engine/passes/common/surface_numbers.h). After shaders/lights/punctual.glsl and per_sample.glsl.
#ifdef HAS_SURFACE_VALUES
uniform frame_usampler2D surface_numbers;
#endif

SurfaceValues values_of_pixel(ivec2 pixel) {
#ifdef HAS_SURFACE_VALUES
  return values_of_surface(int(texelFetch(surface_numbers, pixel, SAMPLE_HERE).r));
#else
  return 0;
#endif
}
