// Interpolation of values from vertices to fragments.
//   SAMPLES: several per pixel. Values are taken where the pixel is covered, not at a centre that its
//   triangle may miss: beyond an edge they would be extrapolated.
//   PER_SAMPLE: the fragment shader runs once for each sample, with the values there
#if defined(SAMPLES) && defined(PER_SAMPLE)
#define VARYING sample
#elif defined(SAMPLES)
#define VARYING centroid
#else
#define VARYING
#endif
