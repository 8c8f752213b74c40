#include "verify/hunt_settings.h"

#include "shared/cull_settings.h"
#include "verify/check.h"

namespace lightgrid::verify {
namespace {

// Variants that depth_cases and light_cases build anyway.
void choose_from_few(HuntSetting& s, Random& random) {
  const bool vary_test = chance(random, 0.5);
  if (vary_test)
    s.options.cull_test = one_of(random, cull_tests).test;
  else
    s.options.depth_bounds = one_of(random, depth_bounds_modes).mode;
  s.spots = vary_test && chance(random, 0.5);
  if (!vary_test && s.options.depth_bounds == DepthBoundsMode::minmax) {
    s.slices = one_of(random, {1, 24});
    s.z_bins = one_of(random, {1, 256});
  }
}

}  // namespace

HuntSetting random_setting(Random& random, bool few) {
  HuntSetting s;
  CullerOptions& o = s.options;
  o.tile = one_of(random, {8, 16, 16, 32, 64});
  if (few) {
    choose_from_few(s, random);
    return s;
  }
  o.cull_test = one_of(random, cull_tests).test, o.depth_bounds = one_of(random, depth_bounds_modes).mode;
  s.slices = one_of(random, {1, 24});
  s.z_bins = one_of(random, {1, 64});
  s.spots = chance(random, 0.5);
  o.lists = s.slices == 1 && chance(random, 0.25) ? GridLists::masks : GridLists::lists;
  o.samples = chance(random, 0.85) ? 1 : one_of(random, {2, 4, 8});
  o.index_bits = chance(random, 0.2) ? 32 : 0;
  o.portable = chance(random, 0.1);
  s.both_shapes = chance(random, 1.0 / 16);
  return s;
}

void vary(HuntSetting& s, Random& random) {
  s.spacing = chance(random, 0.7) ? SliceSpacing::exponential : SliceSpacing::linear;
  if (s.slices > 1) s.slices = one_of(random, {2, 4, 8, 16, 24, 64});
  if (s.z_bins > 1) s.z_bins = one_of(random, {16, 64, 256});
  s.options.pixel_centres = chance(random, 0.85);
}

std::string to_string(const HuntSetting& s) {
  const CullerOptions& o = s.options;
  std::string text = to_string(o);
  const auto add = [&](bool there, const std::string& words) { text += there ? " " + words : ""; };
  add(s.slices > 1, fmt::format("slices {}", s.slices));
  add(s.z_bins > 1, fmt::format("z-bins {}", s.z_bins));
  add((s.slices > 1 || s.z_bins > 1) && s.spacing == SliceSpacing::linear, "linear");
  add(o.lists == GridLists::masks, "masks");
  add(o.samples > 1, fmt::format("samples {}", o.samples));
  add(!o.pixel_centres, "whole pixels");
  add(o.index_bits == 32, "32-bit indices");
  add(o.portable, "portable");
  add(s.spots, "spots");
  add(o.blend, "blended");
  add(o.depth_format != DepthFormat::d32f, o.depth_format == DepthFormat::d16 ? "d16" : "d24");
  return text;
}

}  // namespace lightgrid::verify
