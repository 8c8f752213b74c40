// What a vertex passes to fragments.
//   SAMPLES: several a pixel. A fragment has its values where the pixel is covered, and not at a centre that its
//   triangle may miss: beyond an edge they would be extrapolated.
//   PER_SAMPLE: the fragment shader runs once for each sample, with the values there
#if defined(SAMPLES) && defined(PER_SAMPLE)
#define VARYING sample
#elif defined(SAMPLES)
#define VARYING centroid
#else
#define VARYING
#endif
