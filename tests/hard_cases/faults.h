// Faults of naive culling code that NaiveCuller can have.
#pragma once

namespace lightgrid::lab::verify {

enum class Fault {
  none,
  float_without_slack,    // planes and box in float, the radius without slack
  cross_product_planes,   // side planes as cross products of rays through the corners, in float
  box_ends_swapped,       // the box from x0 * near and x1 * far, ignoring signs
  symmetric_frustum,      // slopes from the field of view alone
  sky_in_maximum,         // background counts as far
  invalid_depth_ignored,  // NaN, infinite, negative depth ignored
  signed_minimum,         // the least depth by its bits as a signed integer
  last_pixel_forgotten,   // the last pixel of each tile
  partial_tiles_dropped,
  first_sample_only,
  viewport_ignored,
  format_ignored,              // no widening by the format's step
  standard_depth_as_reversed,  // only the sky's value decides
  empty_interval_as_range,     // near and far sorted
  mask_bin_32,                 // 32 slots, the last value past them; no slot at all if zmin = zmax
  eight_bit_counts,
  zero_means_none,
  capacity_of_256,
  sixteen_bit_indices,
  order_by_chance,
  centres_only,         // lights whose centre is behind the eye or past far
  projected_rectangle,  // radius / distance around the projected centre
  float_world,          // world positions as float
  radius_squared,       // -r as r
  no_cones_past_90,     // the cone-sphere test, at any angle
  last_slice_closed,
  first_slice_from_near,  // from half its edge
  world_direction,        // cone axes not turned into view space
  z_bin_of_centre,        // a light only in the z-bin of its centre
  last_z_bin_closed,
  cones_without_position_error,  // positions as float relative to the lights' median; only the radius is
                                 // grown for that
  dropped_by_the_median,         // lights farther than 10^18 m from the lights' median
  edges_not_widened,             // slices and z-bins end on their edges, not on the edges' rounded depths
  mask_of_stored_depth,          // mask bits at the stored depths, without the format's step
  mask_in_float,                 // mask bits from distances in float, even where these cancel
  slopes_in_float,        // tile sides from scale * pixel + offset in float; slack only from the light's
                          // coordinates
  squares_underflow,      // the box test in float: slack, but no absolute term
  projections_unchecked,  // any matrix with positive scales is accepted
  totals_of_32_bits,      // sums of list entries
  edges_of_both,          // a pixel's centre on an edge belongs to both triangles
  edges_of_none,
  edges_in_float,
  no_near_cut,  // corners behind the eye are projected as they are
  first_of_equal_depths,
  mirrors_ignored,   // front faces are counter-clockwise whatever the instance's matrix
  capacity_of_4096,  // triangles
  invalid_is_zero,   // NaN and infinite positions become 0
  samples_at_centres,
  samples_upside_down,  // y down taken for y up
  depth_of_centres,     // one a pixel, for all of its samples
  box_of_centres,       // pixels are left out whose centres lie outside of the triangle's box
  last_sample_as_first,
};

}  // namespace lightgrid::lab::verify
