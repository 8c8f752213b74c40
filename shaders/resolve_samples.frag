// The mean of a pixel's samples, in linear light. SAMPLES: how many there are.
uniform sampler2DMS image;

layout(location = 0) out vec4 color;

void main() {
  vec4 sum = vec4(0.0);
  for (int s = 0; s < SAMPLES; ++s) sum += texelFetch(image, ivec2(gl_FragCoord.xy), s);
  color = sum * (1.0 / float(SAMPLES));
}
