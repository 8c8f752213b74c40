// The light groups of a pixel whose instance is not known, from the image of the numbers of masks
// (src/engine/passes/common/group_numbers.h). After shaders/lights/punctual.glsl and per_sample.glsl.
//   GROUPS: there is one; else a pixel has every group
#ifdef GROUPS
uniform frame_usampler2D group_numbers;

int groups_of_pixel(ivec2 pixel) {
  int number = int(texelFetch(group_numbers, pixel, SAMPLE_HERE).r);
  return int(texelFetch(light_group_masks, int(view.light_count + view.directional_count) + number).r);
}
#endif
