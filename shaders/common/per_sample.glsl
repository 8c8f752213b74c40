// Images of the frame that have SAMPLES a pixel where that is defined. Reading one at gl_SampleID makes OpenGL run
// a shader for each sample that is covered, at its place.
//   AT_CENTRES: of one sample all the same
#if defined(SAMPLES) && !defined(AT_CENTRES)
#define frame_sampler2D sampler2DMS
#define frame_usampler2D usampler2DMS
#define SAMPLE_HERE gl_SampleID
vec2 place_of_sample() { return floor(gl_FragCoord.xy) + gl_SamplePosition; }
#else
#define frame_sampler2D sampler2D
#define frame_usampler2D usampler2D
#define SAMPLE_HERE 0
vec2 place_of_sample() { return gl_FragCoord.xy; }
#endif
