// The hard cases distinguish right from wrong: a correct culler passes all of them, and each fault of naive
// code is caught by the cases for it.
#include <gtest/gtest.h>

#include <set>

#include "hard_cases/naive_culler.h"
#include "verify/run.h"

namespace lightgrid::lab::verify {
namespace {

constexpr uint64_t few_adversarial_lights = 4096;

struct Caught {
  const char* name;
  Fault fault;
  std::vector<std::string> by;
};

std::vector<Caught> faults() {
  return {
      {"float_without_slack",
       Fault::float_without_slack,
       {"lights/tangent_to_faces", "lights/tangent_to_edges", "lights/tangent_to_corners",
        "lights/an_ulp_off_tangent", "lights/some_ulps_off_tangent", "lights/adversarial",
        "lights/huge_and_tangent", "camera/field_of_a_tenth"}},
      {"cross_product_planes",
       Fault::cross_product_planes,
       {"camera/field_of_a_tenth", "lights/adversarial"}},
      {"box_ends_swapped",
       Fault::box_ends_swapped,
       {"camera/beside_the_axis", "camera/field_of_170", "camera/off_centre"}},
      {"symmetric_frustum",
       Fault::symmetric_frustum,
       {"camera/off_centre", "camera/beside_the_axis", "camera/orthographic_off_centre",
        "camera/pixels_in_their_tiles", "camera/jittered"}},
      {"sky_in_maximum", Fault::sky_in_maximum, {"depth/all_sky", "depth/sky_beside_surface"}},
      {"invalid_depth_ignored",
       Fault::invalid_depth_ignored,
       {"depth/nan_depth", "depth/infinite_depth", "depth/negative_depth", "depth/depth_above_one"}},
      {"signed_minimum", Fault::signed_minimum, {"depth/negative_depth", "depth/minus_zero"}},
      {"last_pixel_forgotten",
       Fault::last_pixel_forgotten,
       {"depth/one_pixel_shows", "depth/extremes_anywhere"}},
      {"partial_tiles_dropped",
       Fault::partial_tiles_dropped,
       {"depth/one_pixel_image", "depth/one_row_image", "depth/odd_size"}},
      {"first_sample_only", Fault::first_sample_only, {"depth/several_samples"}},
      {"viewport_ignored", Fault::viewport_ignored, {"depth/viewport"}},
      {"format_ignored",
       Fault::format_ignored,
       {"depth/depth_of_16_bits", "depth/depth_of_24_bits", "depth/depth_of_floats",
        "depth/position_from_depth"}},
      {"standard_depth_as_reversed",
       Fault::standard_depth_as_reversed,
       {"depth/reversed_against_standard", "depth/finite_far"}},
      {"empty_interval_as_range", Fault::empty_interval_as_range, {"depth/empty_interval", "depth/all_sky"}},
      {"mask_bin_32",
       Fault::mask_bin_32,
       {"depth/flat_wall", "depth/at_the_farthest", "depth/on_mask_edges"}},
      {"eight_bit_counts", Fault::eight_bit_counts, {"lists/around_a_byte", "lists/around_batches"}},
      {"zero_means_none", Fault::zero_means_none, {"lists/light_zero_alone", "lists/each_length"}},
      {"capacity_of_256",
       Fault::capacity_of_256,
       {"lights/thousand_coincident", "lists/around_a_byte", "lists/all_in_one_tile",
        "lists/longer_than_expected"}},
      {"sixteen_bit_indices", Fault::sixteen_bit_indices, {"lists/around_16_bits"}},
      {"order_by_chance", Fault::order_by_chance, {"lists/hundred_runs"}},
      {"centres_only",
       Fault::centres_only,
       {"camera/behind_and_reaching_in", "camera/beyond_far", "camera/across_the_near_plane"}},
      {"projected_rectangle",
       Fault::projected_rectangle,
       {"camera/across_the_near_plane", "camera/behind_and_reaching_in", "camera/inside_a_light"}},
      {"float_world",
       Fault::float_world,
       {"camera/world_at_1e6", "camera/world_at_1e7", "camera/world_at_1e8", "camera/between_two_floats"}},
      {"radius_squared", Fault::radius_squared, {"lights/radius_negative"}},
      {"no_cones_past_90",
       Fault::no_cones_past_90,
       {"lights/cone_of_100", "lights/cone_of_120", "lights/cone_of_180"}},
      {"last_slice_closed", Fault::last_slice_closed, {"camera/beyond_the_last_slice"}},
      {"first_slice_from_near", Fault::first_slice_from_near, {"camera/before_the_first_slice"}},
      {"world_direction", Fault::world_direction, {"camera/turned"}},
      {"z_bin_of_centre", Fault::z_bin_of_centre, {"agreement/z_bins_of_lights"}},
      {"last_z_bin_closed", Fault::last_z_bin_closed, {"agreement/z_bins_of_lights"}},
      {"cones_without_position_error", Fault::cones_without_position_error, {"lights/spread_out"}},
      {"dropped_by_the_median", Fault::dropped_by_the_median, {"lights/parked"}},
      {"edges_not_widened",
       Fault::edges_not_widened,
       {"agreement/on_slice_edges", "agreement/on_z_bin_edges"}},
      {"mask_of_stored_depth",
       Fault::mask_of_stored_depth,
       {"depth/depth_of_16_bits", "depth/depth_of_24_bits"}},
      {"mask_in_float", Fault::mask_in_float, {"depth/mask_around_the_eye"}},
      {"slopes_in_float", Fault::slopes_in_float, {"camera/fields_to_179_9"}},
      {"squares_underflow", Fault::squares_underflow, {"lights/outside_of_the_domain"}},
      {"projections_unchecked", Fault::projections_unchecked, {"camera/other_projections"}},
      {"totals_of_32_bits", Fault::totals_of_32_bits, {"lists/past_32_bits"}},
      {"edges_of_both", Fault::edges_of_both, {"raster/on_pixel_centres"}},
      {"edges_of_none", Fault::edges_of_none, {"raster/on_pixel_centres", "raster/fan_of_slivers"}},
      {"edges_in_float", Fault::edges_in_float, {"raster/huge_and_tiny"}},
      {"no_near_cut", Fault::no_near_cut, {"raster/behind_the_eye", "raster/at_w_zero"}},
      {"first_of_equal_depths", Fault::first_of_equal_depths, {"raster/equal_depths"}},
      {"mirrors_ignored", Fault::mirrors_ignored, {"raster/mirrored_and_two_sided"}},
      {"capacity_of_4096", Fault::capacity_of_4096, {"raster/more_than_expected"}},
      {"invalid_is_zero", Fault::invalid_is_zero, {"raster/not_finite"}},
      {"samples_at_centres",
       Fault::samples_at_centres,
       {"samples/one_sample_alone", "samples/bars_between_samples"}},
      {"samples_upside_down",
       Fault::samples_upside_down,
       {"samples/one_sample_alone", "samples/edges_at_samples"}},
      {"depth_of_centres",
       Fault::depth_of_centres,
       {"samples/crossing_planes", "samples/huge_and_tiny_at_samples"}},
      {"box_of_centres",
       Fault::box_of_centres,
       {"samples/one_sample_alone", "samples/beside_borders", "samples/sizes_of_samples"}},
      {"last_sample_as_first", Fault::last_sample_as_first, {"samples/fan_around_a_sample"}},
      {"edges_of_both_at_samples", Fault::edges_of_both, {"samples/on_sample_places"}},
      {"first_of_equal_depths_at_samples", Fault::first_of_equal_depths, {"samples/equal_at_samples"}},
      {"no_near_cut_at_samples",
       Fault::no_near_cut,
       {"samples/around_the_eye_at_samples", "samples/w_zero_at_samples"}},
  };
}

TEST(RightCuller, PassesEveryCase) {
  NaiveCuller culler(Fault::none);
  for (const HardCase& c : hard_cases()) {
    if (c.name == "hundred_runs") continue;  // no evidence for a culler without threads of its own
    const bool draws = std::set<std::string>{"shadows", "lidr", "groups", "caps"}.contains(c.group);
    if (draws) continue;  // which this culler does not
    SCOPED_TRACE(c.name);
    const Outcome outcome = run_case(c, culler, few_adversarial_lights);
    EXPECT_EQ(outcome.verdict, Verdict::pass) << c.group << "/" << c.name << ": " << outcome.why;
    EXPECT_EQ(outcome.lost, 0u);
    EXPECT_GT(outcome.trials, 0u);
  }
}

struct FaultyCuller : testing::TestWithParam<Caught> {};

TEST_P(FaultyCuller, Fails) {
  NaiveCuller culler(GetParam().fault);
  for (const std::string& name : GetParam().by) {
    const auto chosen = chosen_cases("^" + name + "$");
    ASSERT_EQ(chosen.size(), 1u) << name;
    EXPECT_TRUE(fails(*chosen[0], culler, few_adversarial_lights)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(HardCases, FaultyCuller, testing::ValuesIn(faults()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lightgrid::lab::verify
