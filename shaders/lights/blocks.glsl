// A long list of lights, in the order of its entries, in few loop iterations (LONG_LOOPS). llvmpipe
// ends the loops of a shader after 65,535 iterations of all its loops together, without an error
// (Mesa: LP_MAX_TGSI_LOOP_ITERATIONS). Here one iteration tests 64 lights, and each light that may
// reach the point takes one more. The sum has the bits of a loop over all entries: a light that is
// left out would add an exact zero.
//   LIGHT_ENTRIES: there are entries_at(p), the first entry and their number; light_of_entry(i);
//     entry_is_read(light)
#define BLOCK_SIZE 64u

// Returns whether the point may be nearer than the light's range, with room for the rounding of
// shared/punctual_light.h. True for NaN.
bool may_reach(vec3 position, uint light) {
  vec4 at = LIGHT_VALUE(vec4, light_positions, int(light));
  vec3 to_light = at.xyz - position;
  return !(dot(to_light, to_light) * at.w >= 1.0001);
}

bool is_shaded(vec3 position, uint entry, uint end) {
  uint light = light_of_entry(min(entry, end - 1u));
  return entry < end && entry_is_read(light) && may_reach(position, light);
}

// Bits of 32 entries from `first` on, without a loop.
uint shaded_entries(vec3 position, uint first, uint end) {
  uint bits = 0u;
#define TEST(k) bits |= uint(is_shaded(position, first + k, end)) << k;
  TEST(0u) TEST(1u) TEST(2u) TEST(3u) TEST(4u) TEST(5u) TEST(6u) TEST(7u)
  TEST(8u) TEST(9u) TEST(10u) TEST(11u) TEST(12u) TEST(13u) TEST(14u) TEST(15u)
  TEST(16u) TEST(17u) TEST(18u) TEST(19u) TEST(20u) TEST(21u) TEST(22u) TEST(23u)
  TEST(24u) TEST(25u) TEST(26u) TEST(27u) TEST(28u) TEST(29u) TEST(30u) TEST(31u)
#undef TEST
  return bits;
}

vec3 light_sum(ShadingPoint p) {
  uvec2 range = entries_at(p), left = uvec2(0u);
  vec3 sum = vec3(0.0);
  uint block = range.x, end = range.x + range.y;
  for (; block < end; block += BLOCK_SIZE) {
    left = uvec2(shaded_entries(p.position, block, end), shaded_entries(p.position, block + 32u, end));
    while ((left.x | left.y) != 0u) {
      uint half_block = left.x != 0u ? 0u : 1u, bit = uint(findLSB(left[half_block]));
      left[half_block] &= left[half_block] - 1u;
      uint entry = block + half_block * 32u + bit;
#ifdef LIST_FACTORS
      sum += factor_of_entry(entry) * punctual_light(p, int(light_of_entry(entry)));
#else
      sum += punctual_light(p, int(light_of_entry(entry)));
#endif
    }
  }
  return sum_if(block >= end && left == uvec2(0u), sum);
}
