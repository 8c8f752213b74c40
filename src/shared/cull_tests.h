// The tables of cull tests and depth-bounds modes: settings, culling, checks and inspection loop over
// them. A new row also needs its number in shared/cull_settings.h and its kernel text;
// docs/overview.md lists the steps.
#pragma once

#include <iterator>

#include "shared/cull_settings.h"

namespace lightgrid {

// What a light's sphere is tested against, besides the cell's interval of distances. All parts must hold.
struct CullTestRow {
  CullTest test;
  const char* name;  // the setting cull-test
  bool sphere;       // the sphere around the cell's box
  bool planes;       // the cell's side planes
  bool box;          // the cell's box in view space
  bool distance;     // the distance to the cell itself
};

inline constexpr CullTestRow cull_tests[] = {
    {CullTest::sphere, "sphere", true, false, false, false},
    {CullTest::planes, "planes", false, true, false, false},
    {CullTest::aabb, "aabb", false, false, true, false},
    {CullTest::planes_aabb, "planes+aabb", false, true, true, false},
    {CullTest::exact, "exact", false, true, true, true},
};

struct DepthBoundsRow {
  DepthBoundsMode mode;
  const char* name;  // the setting depth-bounds
};

inline constexpr DepthBoundsRow depth_bounds_modes[] = {
    {DepthBoundsMode::none, "none"},
    {DepthBoundsMode::minmax, "minmax"},
    {DepthBoundsMode::halfz, "halfz"},
    {DepthBoundsMode::halfz_modified, "halfz-modified"},
    {DepthBoundsMode::mask32, "mask32"},
};

constexpr const CullTestRow& row_of(CullTest test) { return cull_tests[int(test)]; }
constexpr const DepthBoundsRow& row_of(DepthBoundsMode mode) { return depth_bounds_modes[int(mode)]; }

constexpr bool rows_are_in_order() {
  for (int i = 0; i < int(std::size(cull_tests)); ++i) {
    if (int(cull_tests[i].test) != i) return false;
  }
  for (int i = 0; i < int(std::size(depth_bounds_modes)); ++i) {
    if (int(depth_bounds_modes[i].mode) != i) return false;
  }
  return true;
}
static_assert(rows_are_in_order());

}  // namespace lightgrid
